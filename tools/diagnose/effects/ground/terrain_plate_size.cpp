#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

// Needs plates of more than one radius.
std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  if (c.facts.foot_radius_ratio < 1.05) return {};
  return {{.name = "size_exponent", .typical = 0.3, .low = -2.0, .high = 3.0, .either_sign = true}};
}

const EffectRegistration kEffect(
    {.id = "terrain.plate_size",
     .port = Port::ground,
     .statement =
         "The pressure at a depth depends on the size of the plate (R_0: the median plate's radius).",
     .equation = "F_d -> F_d (R / R_0)^p",
     .bench_tests =
         {{.kind = "press",
           .sentence =
               "Press plates of three sizes slowly to one depth on freshly prepared beds: pressures that "
               "differ are a law of plate size, while a wrong stiffness or load cell shifts all alike."}},
     .plants = {PlantKind::intruder},
     .parameters = parameters,
     .apply = [](const Context& c, const std::string&, std::span<const double> v, Edits& edits) {
       const double exponent = v[0], median_m = c.belief.value("foot.radius_m", 0.04);
       edits.law(LawPort::foot_size,
                 [=](const FootState& s) { return exponent * std::log(s.radius_m / median_m); });
     }});

}  // namespace
}  // namespace sandhopper::diagnose
