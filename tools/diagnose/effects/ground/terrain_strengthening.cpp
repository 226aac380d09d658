#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  if (c.facts.range_of_wait_s <= 0.0) return {};
  return {{.name = "share_per_e_fold", .typical = 0.03, .low = 0.0, .high = 1.0},
          {.name = "time_constant_s", .typical = 2.0, .low = 0.05, .high = 100.0, .shapes = {0.5, 10.0}},
          part_of_unloading()};
}

void apply(const Context&, const std::string&, std::span<const double> v, Edits& edits) {
  const double share = v[0], time_s = v[1];
  stiffen(edits, v[2], [=](const GroundState& s) { return share * std::log1p(s.wait_s / time_s); });
}

const EffectRegistration kEffect(
    {.id = "terrain.strengthening",
     .port = Port::ground,
     .statement = "The bed grows stiffer while it waits.",
     .equation = "F_d -> F_d (1 + A ln(1 + t / t_0))",
     .bench_tests =
         {{.kind = "intrusion",
           .sentence = "Repeat one push on freshly prepared beds that have rested for different times: "
                       "strengthening grows with the rest alone, while compaction needs earlier pushes.",
           .plants = {PlantKind::intruder}},
          {.kind = "hop",
           .sentence = "Repeat one hop on freshly prepared beds that have rested for different times: "
                       "strengthening grows with the rest alone, while compaction needs earlier hops.",
           .plants = {PlantKind::hopper}}},
     .plants = {PlantKind::intruder, PlantKind::hopper},
     .parameters = parameters,
     .apply = apply});

}  // namespace
}  // namespace sandhopper::diagnose
