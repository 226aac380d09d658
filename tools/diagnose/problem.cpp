#include "tools/diagnose/problem.hpp"

#include <bit>

namespace sandhopper::diagnose {
namespace {

std::uint64_t mixed(std::uint64_t key, std::uint64_t value) {
  key ^= value + 0x9e3779b97f4a7c15ull + (key << 6) + (key >> 2);
  return key * 0xff51afd7ed558ccdull;
}

}  // namespace

Point null_point(const Problem& problem) {
  Point point;
  point.tolerances.assign(problem.tolerances.size(), 0.0);
  for (const auto& trial : problem.trials) point.nuisances.emplace_back(trial->nuisance_count(), 0.0);
  return point;
}

Edits edits_for(const Problem& problem, const Hypothesis& hypothesis, std::span<const double> tolerances) {
  Edits edits;
  edits.laws_key = 1;
  for (std::size_t i = 0; i < hypothesis.candidates.size(); ++i) {
    const Candidate& candidate = problem.candidates[hypothesis.candidates[i]];
    const std::size_t laws = edits.laws.size(), sensors = edits.sensors.size();
    candidate.effect->apply(problem.context, candidate.channel, hypothesis.values[i], edits);
    bool law = edits.laws.size() > laws;
    for (std::size_t k = sensors; k < edits.sensors.size(); ++k)
      law = law || edits.sensors[k].kind == SensorEdit::Kind::law;
    if (!law) continue;
    edits.laws_key = mixed(edits.laws_key, hypothesis.candidates[i]);
    for (const double value : hypothesis.values[i])
      edits.laws_key = mixed(edits.laws_key, std::bit_cast<std::uint64_t>(value));
  }
  for (std::size_t i = 0; i < tolerances.size(); ++i)
    if (tolerances[i] != 0.0)
      edits.sensor(problem.tolerances[i].channel, SensorEdit::Kind::delay_s,
                   tolerances[i] * problem.tolerances[i].scale);
  return edits;
}

}  // namespace sandhopper::diagnose
