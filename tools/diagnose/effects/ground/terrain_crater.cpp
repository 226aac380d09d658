#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  if (c.facts.most_pushes <= 0.0) return {};
  const EffectParameter drop{.name = "drop_per_push_m", .typical = 3e-3, .low = -0.01, .high = 0.05};
  // With the same number of pushes before every trial the recordings do not show the power.
  if (c.facts.range_of_pushes <= 0.0) return {drop};
  return {drop,
          // Below 1: a later push lowers the surface less than the first, because the bed becomes firmer.
          {.name = "pushes_power", .typical = 1.0, .low = 0.3, .high = 1.5, .shapes = {0.5}}};
}

void apply(const Context& c, const std::string&, std::span<const double> v, Edits& edits) {
  const double drop_m = v[0], power = c.facts.range_of_pushes > 0.0 ? v[1] : 1.0;
  edits.law(LawPort::ground_surface,
            [=](const GroundState& s) { return -drop_m * std::pow(s.pushes, power); });
}

const EffectRegistration kEffect(
    {.id = "terrain.crater",
     .port = Port::ground,
     .statement = "Each push since the bed was prepared lowers its surface.",
     .equation = "z = z_recorded - c n^p",
     .bench_tests =
         {{.sentence =
               "Measure the height of the bed under the {foot} with a ruler after each push: a crater lowers "
               "it push by push, while compaction or a drifting sensor does not lower it as much."}},
     .plants = {PlantKind::intruder, PlantKind::hopper},
     .parameters = parameters,
     .apply = apply});

}  // namespace
}  // namespace sandhopper::diagnose
