#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  const std::string key = c.plant == PlantKind::hopper ? "robot.body_mass_kg" : "body.mass_kg";
  const double believed = c.belief.value(key, c.plant == PlantKind::hopper ? 1.6 : 1.0);
  return {{.name = c.plant == PlantKind::hopper ? "body_mass_kg" : "mass_kg",
           .typical = 0.05,
           .low = -0.8,
           .high = 4.0,
           .either_sign = true,
           .base = believed,
           .scale = believed}};
}

const EffectRegistration kEffect(
    {.id = "body.mass",
     .port = "inertia",
     .statement = "The body's mass is not what is believed.",
     .equation = "m -> m (1 + e)",
     .plants = {PlantKind::falling_body, PlantKind::hopper},
     .parameters = parameters,
     .apply =
         [](const Context& c, const std::string&, std::span<const double> v, Edits& edits) {
           edits.scale(c.plant == PlantKind::hopper ? "robot.body_mass_kg" : "body.mass_kg", 1.0 + v[0]);
         },
     .belief_key = "body.mass_kg"});

}  // namespace
}  // namespace sandhopper::diagnose
