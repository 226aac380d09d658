#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

constexpr double kVisibleTwist_rad = 0.01;  // half a degree at the torque that usually acts

std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  if (!c.facts.is_driven) return {};
  std::vector<EffectParameter> all{{.name = "compliance_rad_per_Nm",
                                    .typical = kVisibleTwist_rad / c.facts.torque_Nm,
                                    .low = 0.0,
                                    .high = c.facts.angle_rad / c.facts.torque_Nm}};
  if (c.has("velocity_radps"))
    all.push_back({.name = "velocity_on_motor_side", .shapes = {0.0}, .is_whole_range = true});
  return all;
}

const EffectRegistration kEffect(
    {.id = "rig.compliance",
     .port = Port::geometry,
     .statement = "The shaft twists under the torque: the motor, whose angle is recorded, leads the load.",
     .equation = "position = th + c torque; velocity = th' + part c d(torque)/dt",
     .bench_tests = {{.kind = "clamped",
                      .sentence = "Block the far end of the shaft and raise the torque in steps: the "
                                  "recorded angle follows the torque only if the shaft twists; inertia, "
                                  "friction and delays have no effect at rest."}},
     .plants = {PlantKind::rotary_axis},
     .parameters = parameters,
     .apply = [](const Context&, const std::string&, std::span<const double> v, Edits& edits) {
       edits.add("axis.compliance_rad_per_Nm", v[0]);
       if (v.size() > 1) edits.add("axis.velocity_on_motor_side", v[1]);
     }});

}  // namespace
}  // namespace sandhopper::diagnose
