#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  if (c.facts.range_of_pushes <= 0.0) return {};
  return {{.name = "drop_per_push_m", .typical = 3e-3, .low = -0.01, .high = 0.05}};
}

void apply(const Context&, const std::string&, std::span<const double> v, Edits& edits) {
  const double drop_m = v[0];
  edits.law(LawPort::ground_surface, [drop_m](const GroundState& s) { return -drop_m * s.pushes; });
}

const EffectRegistration kEffect(
    {.id = "terrain.crater",
     .port = Port::ground,
     .statement = "Each push since the bed was prepared lowers its surface.",
     .equation = "z = z_recorded - c n",
     .bench_tests =
         {{.sentence =
               "Measure the height of the bed under the {foot} with a ruler after each push: a crater lowers "
               "it push by push, while compaction or a drifting sensor does not lower it as much."}},
     .plants = {PlantKind::intruder, PlantKind::hopper},
     .parameters = parameters,
     .apply = apply});

}  // namespace
}  // namespace sandhopper::diagnose
