#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

constexpr double kUsualPushes = 2.0;  // n_0 if the recordings do not show it: guess

std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  if (c.facts.most_pushes <= 0.0) return {};
  const EffectParameter share{.name = "compaction_share", .typical = 0.2, .low = -0.8, .high = 10.0};
  // With the same number of pushes before every trial the recordings do not show n_0.
  if (c.facts.range_of_pushes <= 0.0) return {share, part_of_unloading()};
  return {share,
          {.name = "pushes", .typical = kUsualPushes, .low = 0.2, .high = 20.0, .shapes = {0.7, 6.0}},
          part_of_unloading()};
}

void apply(const Context& c, const std::string&, std::span<const double> v, Edits& edits) {
  const double share = v[0], pushes = c.facts.range_of_pushes > 0.0 ? v[1] : kUsualPushes;
  stiffen(edits, v.back(),
          [=](const GroundState& s) { return share * (1.0 - std::exp(-s.pushes / pushes)); });
}

const EffectRegistration kEffect(
    {.id = "terrain.compaction",
     .port = Port::ground,
     .statement = "Each push since the bed was prepared makes it stiffer.",
     .equation = "F_d -> F_d (1 + C (1 - exp(-n / n_0)))",
     .bench_tests =
         {{.kind = "intrusion",
           .sentence =
               "Prepare the bed afresh in the middle of a session and repeat its first trial: compaction "
               "starts again from nothing, while a drift of the rig or its sensors goes on.",
           .same_for = {"terrain.crater", "terrain.strengthening"},
           .plants = {PlantKind::intruder}},
          {.kind = "hop",
           .sentence =
               "Prepare the bed afresh in the middle of a session and repeat its first hop at once: "
               "compaction starts again from nothing, while motors stay warm and sensors keep their drift.",
           .same_for = {"terrain.crater", "terrain.strengthening"},
           .plants = {PlantKind::hopper}}},
     .plants = {PlantKind::intruder, PlantKind::hopper},
     .parameters = parameters,
     .apply = apply});

}  // namespace
}  // namespace sandhopper::diagnose
