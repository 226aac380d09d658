#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

constexpr BelievedNumber kPlay{"robot.joint_play_rad"};
constexpr BelievedNumber kGive{"robot.joint_give_relative", 0.3};

std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  const double believed = kPlay.of(c);
  return {{.name = "joint_play_rad", .typical = 5e-3, .low = -believed, .high = 0.1, .base = believed},
          {.name = "joint_give_relative", .typical = 0.2, .low = -0.25, .high = 2.0, .base = kGive.of(c)}};
}

const EffectRegistration kEffect(adds_to(
    {kPlay, kGive},
    {.id = "joint.backlash",
     .port = Port::joint,
     .statement =
         "There is play between motors and links: at each reversal of the torque the links follow later.",
     .equation = "tau_t = K (|p| - play/2) sign(p) + D dp/dt where teeth touch, 0 between; p = rotor - link",
     .bench_tests =
         {{.kind = "hold",
           .sentence =
               "Let the drives hold their angle and push the foot lightly to and fro by hand: play gives way "
               "without force up to a stop, a spring gives way in proportion, friction not at all."}},
     .plants = {PlantKind::hopper},
     .parameters = parameters}));

}  // namespace
}  // namespace sandhopper::diagnose
