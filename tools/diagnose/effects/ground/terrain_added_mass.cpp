#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  const double radius = c.facts.foot_radius_m;
  // Mass of a cone of sand, 60 degrees steep, under the foot: bulk density 1450 kg/m3.
  const double cone = 1450.0 * 1.732 * 3.1416 * radius * radius * radius / 3.0;
  return {{.name = "added_mass_kg", .typical = cone, .low = 0.0, .high = 20.0 * cone},
          {.name = "saturation_depth_m",
           .typical = 0.866 * radius,
           .low = 0.2 * radius,
           .high = 4.0 * radius,
           .shapes = {0.4 * radius, 1.8 * radius}},
          {.name = "growth_power", .typical = 1.0, .low = 1.0, .high = 3.0, .shapes = {2.0}}};
}

void apply(const Context& c, const std::string&, std::span<const double> v, Edits& edits) {
  (void)c;
  const double mass = v[0], depth = v[1], power = v[2];
  const auto taken_up = [=](double z) { return power == 1.0 ? z / depth : std::pow(z / depth, power); };
  edits.law(LawPort::ground_force, [=](const GroundState& s) {
    const double taken = taken_up(s.depth_m), l = std::max(0.0, 1.0 - taken);
    const double gradient = s.depth_m > 0.0 ? 3.0 * mass * power * taken / s.depth_m * l * l : 0.0;
    return s.virgin * gradient * s.speed_mps * s.speed_mps;
  });
  edits.law(LawPort::ground_mass, [=](const GroundState& s) {
    const double l = std::max(0.0, 1.0 - taken_up(s.depth_m));
    return s.virgin * mass * (1.0 - l * l * l) * std::clamp(s.speed_mps / 0.005, 0.0, 1.0);
  });
}

const EffectRegistration kEffect(
    {.id = "terrain.added_mass",
     .port = Port::ground,
     .statement = "Grains that move with the foot add to its inertia; as they are taken up with depth they "
                  "also resist with the square of speed.",
     .equation = "F += m_a(z) z'' + m_a'(z) z'^2, m_a = m (1 - (1 - (z/z_c)^p)^3)",
     .bench_tests =
         {{.kind = "intrusion",
           .sentence =
               "Start the plate from rest inside the bed at full acceleration, and again in air: resistance "
               "at the first instant that only the bed shows is added mass, because drag needs speed.",
           .plants = {PlantKind::intruder}},
          {.kind = "hop",
           .sentence =
               "Record a hop with the stiffest leg and look just before the foot turns back in the bed: drag "
               "is gone at that speed, added mass still acts, and a wrong foot mass shows in flight, too.",
           .plants = {PlantKind::hopper}}},
     .plants = {PlantKind::intruder, PlantKind::hopper},
     .parameters = parameters,
     .apply = apply});

}  // namespace
}  // namespace sandhopper::diagnose
