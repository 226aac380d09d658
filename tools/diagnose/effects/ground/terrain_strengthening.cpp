#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

constexpr double kUsual_s = 2.0;  // t_0 if the recordings do not show it: guess

std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  if (c.facts.longest_wait_s <= 0.0) return {};
  const EffectParameter share{.name = "share_per_e_fold", .typical = 0.03, .low = 0.0, .high = 1.0};
  // With the same wait before every trial the recordings do not show t_0.
  if (c.facts.range_of_wait_s <= 0.0) return {share, part_of_unloading()};
  return {share,
          {.name = "time_constant_s", .typical = kUsual_s, .low = 0.05, .high = 100.0, .shapes = {0.5, 10.0}},
          part_of_unloading()};
}

void apply(const Context& c, const std::string&, std::span<const double> v, Edits& edits) {
  const double share = v[0], time_s = c.facts.range_of_wait_s > 0.0 ? v[1] : kUsual_s;
  stiffen(edits, v.back(), [=](const GroundState& s) { return share * std::log1p(s.wait_s / time_s); });
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
