#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

bool hangs(const Context& c) { return c.belief.value("axis.gravity_torque_Nm") != 0.0; }

// An arm that runs free hangs at another angle, and nothing turns it: a constant torque beside the angle
// would make gravity weaker, G cos(theta_0), which is another finding.
bool hangs_free(const Context& c) { return hangs(c) && !c.facts.is_driven; }

// A constant torque, or the angle at which the arm hangs, or for a driven arm both.
std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  const double typical = 0.05 * c.facts.torque_Nm;
  const EffectParameter torque{.name = "torque_offset_Nm",
                               .typical = typical,
                               .low = -100.0 * typical,
                               .high = 100.0 * typical,
                               .either_sign = true};
  EffectParameter angle{.name = "offset_rad", .typical = 0.03, .low = -0.5, .high = 0.5, .either_sign = true};
  if (hangs_free(c)) return {angle};
  if (!hangs(c)) return {torque};
  angle.amplitude = true;
  return {torque, angle};
}

void apply(const Context& c, const std::string&, std::span<const double> v, Edits& edits) {
  if (hangs(c)) edits.add("axis.bottom_rad", v.back());
  if (hangs_free(c)) return;
  edits.law(LawPort::axis, [torque = v[0]](const PortState&) { return torque; });
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
