#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  const double believed = c.belief.value("medium.linear_drag_N_s_per_m");
  const double typical = 0.1 * c.facts.weight_N / c.facts.speed_mps;
  return {{.name = "linear_drag_N_s_per_m",
           .typical = typical,
           .low = -believed,
           .high = 100.0 * typical,
           .base = believed}};
}

// If the belief has such a drag, every trial's own changes by the same share, as with another viscosity.
void apply(const Context& c, const std::string&, std::span<const double> v, Edits& edits) {
  const std::string key = "medium.linear_drag_N_s_per_m";
  if (const double believed = c.belief.value(key); believed > 0.0)
    return edits.scale(key, 1.0 + v[0] / believed);
  edits.add(key, v[0]);
}

const EffectRegistration kEffect(
    {.id = "air.linear_drag",
     .port = Port::body,
     .statement = "A force proportional to speed opposes the fall: the medium, a guide, or eddy currents.",
     .equation = "F += -b v",
     .bench_tests =
         {{.sentence =
               "Tow the body by a force gauge through the medium at a steady speed and at twice of it: "
               "linear drag doubles, quadratic drag grows fourfold, and mass and added mass add nothing."}},
     .plants = {PlantKind::falling_body},
     .parameters = parameters,
     .apply = apply,
     .belief_key = "medium.linear_drag_N_s_per_m"});

}  // namespace
}  // namespace sandhopper::diagnose
