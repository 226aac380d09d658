#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

const EffectRegistration kEffect(
    {.id = "joint.viscous",
     .port = Port::joint,
     .statement = "Friction proportional to speed acts in the joints.",
     .equation = "tau += -b w, each motor",
     .bench_tests = {{.kind = "air_sweep",
                      .sentence = "Sweep the foot in the air with the body clamped at three speeds: viscous "
                                  "friction of the joints adds torque in proportion to speed, dry friction "
                                  "does not, and the rail does not move."}},
     .plants = {PlantKind::hopper},
     .parameters =
         [](const Context&, const std::string&) {
           return std::vector<EffectParameter>{
               {.name = "joint_viscous_Nm_s_per_rad", .typical = 5e-3, .low = 0.0, .high = 0.2}};
         },
     .apply =
         [](const Context& c, const std::string&, std::span<const double> v, Edits& edits) {
           const double factor = v[0] * c.belief.value("robot.motor_count", 2.0);
           edits.law(LawPort::joint, [factor](const AxisState& s) { return -factor * s.velocity_radps; });
         }});

}  // namespace
}  // namespace sandhopper::diagnose
