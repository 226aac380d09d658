#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

constexpr const char* kPlay = "robot.joint_play_rad";
constexpr const char* kGive = "robot.joint_give_relative";

std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  const double believed = c.belief.value(kPlay);
  return {{.name = "joint_play_rad", .typical = 5e-3, .low = -believed, .high = 0.1, .base = believed},
          {.name = "joint_give_relative",
           .typical = 0.2,
           .low = -0.25,
           .high = 2.0,
           .base = c.belief.value(kGive, 0.3)}};
}

void apply(const Context&, const std::string&, std::span<const double> v, Edits& edits) {
  edits.add(kPlay, v[0]);
  edits.add(kGive, v[1]);
}

bool as_keys(const Context& c, std::span<const double> v, std::map<std::string, double>& numbers) {
  numbers[kPlay] = c.belief.value(kPlay) + v[0];
  numbers[kGive] = c.belief.value(kGive, 0.3) + v[1];
  return true;
}

const EffectRegistration kEffect(
    {.id = "joint.backlash",
     .port = "joint",
     .statement = "There is play between motors and links: each reversal of the torque costs it.",
     .equation = "tau_t = K (|p| - play/2) sign(p) + D dp/dt where teeth touch, 0 between; p = rotor - link",
     .plants = {PlantKind::hopper},
     .parameters = parameters,
     .apply = apply,
     .as_keys = as_keys});

}  // namespace
}  // namespace sandhopper::diagnose
