#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  const double typical = 20.0 * std::pow(c.facts.foot_radius_m / 0.04, 2);
  return {{.name = "coupling_share", .typical = 0.25, .low = -0.8, .high = 5.0, .either_sign = true},
          {.name = "coupling_speed_mps", .typical = 0.3, .low = 0.02, .high = 3.0, .shapes = {0.08, 1.0}},
          {.name = "speed_law_N_s2_per_m2",
           .typical = typical,
           .low = 0.0,
           .high = 50.0 * typical,
           .amplitude = true}};
}

void apply(const Context&, const std::string&, std::span<const double> v, Edits& edits) {
  const double share = v[0], speed = v[1], factor = v[2];
  edits.law(LawPort::ground_force, [=](const GroundState& s) {
    const double square = s.speed_mps * s.speed_mps;
    const double law = std::max(0.0, factor * square - s.quasi_static_N);
    return s.virgin * (share * s.quasi_static_N * square / (square + speed * speed) + law);
  });
}

const EffectRegistration kEffect(
    {.id = "terrain.depth_speed_coupling",
     .port = Port::ground,
     .statement = "Speed and depth do not add: speed changes the resistance in proportion to depth, or the "
                  "larger of a depth law and a speed law acts.",
     .equation = "F = F_d (1 + s v^2 / (v^2 + v_0^2)) or max(F_d, c v^2)",
     .bench_tests =
         {{.kind = "intrusion",
           .sentence =
               "Push the {foot} in at two steady speeds and compare shallow with deep: the force that speed "
               "adds is the same at both depths if depth and speed add, and changes with depth if not."}},
     .plants = {PlantKind::intruder, PlantKind::hopper},
     .parameters = parameters,
     .apply = apply});

}  // namespace
}  // namespace sandhopper::diagnose
