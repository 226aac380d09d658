#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

// A constant torque and, if gravity acts, an offset of the angle at which the arm hangs.
std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  const double typical = 0.05 * c.facts.torque_Nm;
  std::vector<EffectParameter> all{{.name = "torque_offset_Nm",
                                    .typical = typical,
                                    .low = -100.0 * typical,
                                    .high = 100.0 * typical,
                                    .either_sign = true}};
  if (c.belief.value("axis.gravity_torque_Nm") != 0.0)
    all.push_back({.name = "offset_rad",
                   .typical = 0.03,
                   .low = -0.5,
                   .high = 0.5,
                   .either_sign = true,
                   .amplitude = true});
  return all;
}

void apply(const Context&, const std::string&, std::span<const double> v, Edits& edits) {
  const double torque = v[0];
  edits.law(LawPort::axis, [torque](const PortState&) { return torque; });
  if (v.size() > 1) edits.add("axis.bottom_rad", v[1]);
}

const EffectRegistration kEffect(
    {.id = "axis.offset",
     .port = Port::axis,
     .statement = "A constant torque acts that the recorded torque does not show, or "
                  "the arm hangs at another angle than believed.",
     .equation = "tau += tau_0, G sin(theta) -> G sin(theta - theta_0)",
     .bench_tests =
         {{.kind = "hold",
           .sentence = "Let the arm hang with the drive off and check it with a plumb line: it hangs askew "
                       "only if a torque or its balance turns it, while a false reading turns nothing."}},
     .plants = {PlantKind::rotary_axis},
     .parameters = parameters,
     .apply = apply});

}  // namespace
}  // namespace sandhopper::diagnose
