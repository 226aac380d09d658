#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  if (!has_bed(c)) return {};
  const double depth = c.facts.depth_m;
  const double believed = c.belief.value("terrain.stiffness_per_area_N_per_m3") > 0.0
                              ? c.belief.value("terrain.exponent", 1.0)
                              : 1.0;
  return {
      {.name = "exponent", .typical = 0.3, .low = -0.8, .high = 3.0, .either_sign = true, .base = believed},
      {.name = "reference_depth_m",
       .typical = 0.5 * depth,
       .low = 0.02 * depth,
       .high = 5.0 * depth,
       .shapes = {0.01, depth}}};
}

void apply(const Context& c, const std::string&, std::span<const double> v, Edits& edits) {
  (void)c;
  const double power = v[0], reference = v[1];
  edits.law(LawPort::ground_factor, [=](const GroundState& s) {
    return s.depth_m > 0.0 ? std::pow(std::max(s.depth_m / reference, 1e-3), power) - 1.0 : 0.0;
  });
}

// K A z (z / 1 cm)^(n-1) (z / z_r)^p has the same form with other K and n.
bool as_keys(const Context& c, std::span<const double> v, std::map<std::string, double>& numbers) {
  constexpr double kReference_m = 0.01;
  if (!(c.belief.value("terrain.stiffness_per_area_N_per_m3") > 0.0)) return false;
  numbers["terrain.exponent"] = c.belief.value("terrain.exponent", 1.0) + v[0];
  numbers["terrain.stiffness_per_area_N_per_m3"] *= std::pow(kReference_m / v[1], v[0]);
  return true;
}

const EffectRegistration kEffect(
    {.id = "terrain.depth_power_law",
     .port = Port::ground,
     .statement = "Resistance grows with another power of depth than believed.",
     .equation = "F_d -> F_d (z / z_r)^(n - n_0)",
     .bench_tests = {{.kind = "press",
                      .sentence = "Press the {foot} very slowly to its full depth and plot force over depth "
                                  "on logarithmic scales: a power law is a straight line; a crust, a tilt, a "
                                  "false zero or the floor bends it; drag has no effect."}},
     .plants = {PlantKind::intruder, PlantKind::hopper, PlantKind::falling_body},
     .parameters = parameters,
     .apply = apply,
     .as_keys = as_keys});

}  // namespace
}  // namespace sandhopper::diagnose
