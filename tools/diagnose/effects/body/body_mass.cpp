#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

const char* mass_key(const Context& c) {
  return c.plant == PlantKind::hopper ? "robot.body_mass_kg" : "body.mass_kg";
}

double believed_kg(const Context& c) {
  return c.belief.value(mass_key(c), c.plant == PlantKind::hopper ? 1.6 : 1.0);
}

std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  std::vector<EffectParameter> all{{.name = c.plant == PlantKind::hopper ? "body_mass_kg" : "mass_kg",
                                    .typical = 0.05,
                                    .low = -0.8,
                                    .high = 4.0,
                                    .either_sign = true,
                                    .base = believed_kg(c),
                                    .scale = believed_kg(c)}};
  // The error is proportional to each mass (scale of the balance) or the same for all (an unweighed part).
  if (c.facts.masses_differ)
    all.push_back({.name = "part_in_proportion", .shapes = {0.0}, .is_whole_range = true});
  return all;
}

void apply(const Context& c, const std::string&, std::span<const double> v, Edits& edits) {
  const double in_proportion = v.size() > 1 ? v[1] : 1.0;
  edits.scale(mass_key(c), 1.0 + in_proportion * v[0]);
  if (in_proportion < 1.0) edits.add(mass_key(c), (1.0 - in_proportion) * v[0] * believed_kg(c));
}

const EffectRegistration kEffect(
    {.id = "body.mass",
     .port = Port::inertia,
     .statement = "The body's mass is not the believed one.",
     .equation = "m -> m + e (p m + (1 - p) m_0), p = 1 if all trials have one mass m_0",
     .bench_tests = {{.sentence = "Weigh the body on a balance in air: a wrong mass shows there; drag, added "
                                  "mass and faults of the drop's sensors do not.",
                      .plants = {PlantKind::falling_body}},
                     {.sentence = "Weigh the body on a balance, without foot and links: a wrong mass shows "
                                  "there; motors, rail, cable and sensors have no effect.",
                      .plants = {PlantKind::hopper}}},
     .plants = {PlantKind::falling_body, PlantKind::hopper},
     .parameters = parameters,
     .apply = apply,
     .belief_key = "body.mass_kg"});

}  // namespace
}  // namespace sandhopper::diagnose
