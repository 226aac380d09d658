#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

bool displaced_known(const Context& c) {
  return c.belief.value("medium.density_kg_per_m3") > 0.0 && c.belief.value("body.volume_m3") > 0.0;
}

// True if the body enters a liquid: then the added mass grows with depth.
bool enters(const Context& c) { return c.facts.wetted_over_m > 0.0; }

std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  if (enters(c)) {
    const double mass = c.belief.value("body.mass_kg", 1.0), length = c.facts.wetted_over_m;
    return {{.name = "added_mass_kg", .typical = 0.02 * mass, .low = 0.0, .high = 2.0 * mass},
            {.name = "taken_up_over_m",
             .typical = 0.2 * length,
             .low = 0.01 * length,
             .high = 2.0 * length,
             .shapes = {0.05 * length}}};
  }
  if (!displaced_known(c)) return {};  // Without density or volume there is no added mass to compute.
  const double believed = c.belief.value("medium.added_mass_factor");
  const double displaced_kg = c.belief.value("medium.density_kg_per_m3") * c.belief.value("body.volume_m3");
  const double whole = c.belief.value("body.mass_kg", 1.0) / displaced_kg;
  return {{.name = "added_mass_factor",
           .typical = std::max(0.3, 0.02 * whole),
           .low = -believed,
           .high = std::max(3.0, whole),
           .base = believed}};
}

void apply(const Context& c, const std::string&, std::span<const double> v, Edits& edits) {
  if (!enters(c)) return edits.add("medium.added_mass_factor", v[0]);
  const double mass_kg = v[0], over_m = v[1];
  edits.law(LawPort::body_added_mass,
            [=](const BodyState& s) { return mass_kg * come_in(s.depth_m, over_m); });
}

const EffectRegistration kEffect(
    {.id = "fluid.added_mass",
     .port = Port::body,
     .statement = "The body sets fluid around it in motion, which adds to its inertia but not to its weight.",
     .equation = "(m + C_m rho V) h'' = F; into a liquid (m + m_a(d)) h'' = F + m_a'(d) h'^2",
     .bench_tests =
         {{.sentence = "Let the body bob on a soft spring in the fluid and out of it: added mass makes the "
                       "period longer, while drag only damps and buoyancy only moves the rest position."}},
     .plants = {PlantKind::falling_body},
     .parameters = parameters,
     .apply = apply,
     .belief_key = "medium.added_mass_factor"});

}  // namespace
}  // namespace sandhopper::diagnose
