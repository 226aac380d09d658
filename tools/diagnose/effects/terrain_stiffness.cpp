#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  const double k = c.belief.value("terrain.stiffness_N_per_m", 1500.0);
  const double per_area = c.belief.value("terrain.stiffness_per_area_N_per_m3");
  const double believed = per_area > 0.0 ? per_area : k;
  return {{.name = per_area > 0.0 ? "stiffness_per_area_N_per_m3" : "stiffness_N_per_m",
           .typical = 0.1,
           .low = -0.95,
           .high = 30.0,
           .either_sign = true,
           .base = believed,
           .scale = believed}};
}

void apply(const Context& c, const std::string&, std::span<const double> v, Edits& edits) {
  const bool per_area = c.belief.value("terrain.stiffness_per_area_N_per_m3") > 0.0;
  edits.scale(per_area ? "terrain.stiffness_per_area_N_per_m3" : "terrain.stiffness_N_per_m", 1.0 + v[0]);
}

const EffectRegistration kEffect({.id = "terrain.stiffness",
                                  .port = "ground",
                                  .statement = "The bed is stiffer or softer than believed.",
                                  .equation = "F_d -> (1 + e) F_d",
                                  .plants = {PlantKind::intruder, PlantKind::hopper},
                                  .parameters = parameters,
                                  .apply = apply,
                                  .belief_key = "terrain.stiffness_N_per_m"});

}  // namespace
}  // namespace sandhopper::diagnose
