#include "tools/diagnose/effects/common.hpp"
#include "tools/diagnose/plants/falling_body/falling_simulation.hpp"

namespace sandhopper::diagnose {
namespace {

bool displaced_known(const Context& c) {
  return c.belief.value("medium.density_kg_per_m3") > 0.0 && c.belief.value("body.volume_m3") > 0.0;
}

std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  if (displaced_known(c)) {
    const double believed = c.belief.value("medium.buoyancy_factor");
    // Allow nearly the whole weight: in a thin medium the factor may stand for another force.
    const double displaced_kg = c.belief.value("medium.density_kg_per_m3") * c.belief.value("body.volume_m3");
    const double whole = c.belief.value("body.mass_kg", 1.0) / displaced_kg;
    return {{.name = "buoyancy_factor",
             .typical = std::max(0.3, 0.02 * whole),
             .low = -believed,
             .high = std::max(3.0, 0.95 * whole) - believed,
             .base = believed}};
  }
  const double weight = c.facts.weight_N;
  return {{.name = "buoyancy_force_N", .typical = 0.05 * weight, .low = 0.0, .high = 0.95 * weight}};
}

void apply(const Context& c, const std::string&, std::span<const double> v, Edits& edits) {
  if (displaced_known(c)) return edits.add("medium.buoyancy_factor", v[0]);
  const double force = v[0], length = c.facts.wetted_over_m;
  edits.law(LawPort::body, [=](const BodyState& s) { return force * wetted_share(s.depth_m, length); });
}

const EffectRegistration kEffect(
    {.id = "fluid.buoyancy",
     .port = Port::body,
     .statement = "The medium carries part of the weight, whatever the speed.",
     .equation = "F += B rho V g",
     .bench_tests =
         {{.sentence =
               "Weigh the body at rest in the fluid and out of it: the weight that it loses is buoyancy, "
               "since drag and added mass need motion and a wrong mass shows out of the fluid."}},
     .plants = {PlantKind::falling_body},
     .parameters = parameters,
     .apply = apply,
     .belief_key = "medium.buoyancy_factor"});

}  // namespace
}  // namespace sandhopper::diagnose
