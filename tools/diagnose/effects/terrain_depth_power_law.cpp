#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  const double depth = c.scale("depth_m", 0.04);
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
  edits.law("ground.factor", [=](const PortState& s) {
    return s.position > 0.0 ? std::pow(std::max(s.position / reference, 1e-3), power) - 1.0 : 0.0;
  });
}

const EffectRegistration kEffect({.id = "terrain.depth_power_law",
                                  .port = "ground",
                                  .statement = "Resistance grows with another power of depth than believed.",
                                  .equation = "F_d -> F_d (z / z_r)^(n - n_0)",
                                  .plants = {PlantKind::intruder, PlantKind::hopper},
                                  .parameters = parameters,
                                  .apply = apply});

}  // namespace
}  // namespace sandhopper::diagnose
