#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

bool displaced_known(const Context& c) {
  return c.belief.value("medium.density_kg_per_m3") > 0.0 && c.belief.value("body.volume_m3") > 0.0;
}

std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  if (!displaced_known(c)) return {};  // without a medium that has mass there is nothing to carry along
  const double believed = c.belief.value("medium.added_mass_factor");
  const double displaced_kg = c.belief.value("medium.density_kg_per_m3") * c.belief.value("body.volume_m3");
  const double whole = c.belief.value("body.mass_kg", 1.0) / displaced_kg;
  return {{.name = "added_mass_factor",
           .typical = std::max(0.3, 0.02 * whole),
           .low = -believed,
           .high = std::max(3.0, whole),
           .base = believed}};
}

const EffectRegistration kEffect(
    {.id = "fluid.added_mass",
     .port = "body",
     .statement = "The body sets fluid around it in motion, which adds to its inertia but not to its weight.",
     .equation = "(m + C_m rho V) h'' = F",
     .plants = {PlantKind::falling_body},
     .parameters = parameters,
     .apply = [](const Context&, const std::string&, std::span<const double> v,
                 Edits& edits) { edits.add("medium.added_mass_factor", v[0]); },
     .belief_key = "medium.added_mass_factor"});

}  // namespace
}  // namespace sandhopper::diagnose
