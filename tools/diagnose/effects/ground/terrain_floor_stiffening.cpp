#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  const double radius = c.facts.foot_radius_m;
  return {{.name = "stiffening_at_deepest", .typical = 0.2, .low = 0.0, .high = 10.0},
          {.name = "stiffening_length_m",
           .typical = 0.4 * radius,
           .low = 0.05 * radius,
           .high = 2.0 * radius,
           .shapes = {0.15 * radius, 0.8 * radius}}};
}

void apply(const Context& c, const std::string&, std::span<const double> v, Edits& edits) {
  const double amount = v[0], length = v[1], deepest = c.facts.depth_m;
  const double nearest = c.facts.floor_distance_m.value_or(0.0);
  edits.law(LawPort::ground_factor, [=](const GroundState& s) {
    const double beyond = s.bed_depth_m > 0.0 ? s.depth_m - s.bed_depth_m + nearest : s.depth_m - deepest;
    return amount * std::exp(std::min(beyond / length, 20.0));
  });
}

const EffectRegistration kEffect(
    {.id = "terrain.floor_stiffening",
     .port = Port::ground,
     .statement = "Near the floor of the container the bed stiffens exponentially.",
     .equation = "F_d -> F_d (1 + A exp((z - z_nearest) / l))",
     .bench_tests = {{.kind = "press",
                      .sentence = "Repeat a slow press in a bed of twice the depth: stiffening by the floor "
                                  "is gone at the old depth, while a power law of depth is still there."}},
     .plants = {PlantKind::intruder, PlantKind::hopper},
     .parameters = parameters,
     .apply = apply});

}  // namespace
}  // namespace sandhopper::diagnose
