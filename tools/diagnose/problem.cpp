#include "tools/diagnose/problem.hpp"

namespace sandhopper::diagnose {

Point null_point(const Problem& problem) {
  Point point;
  point.tolerances.assign(problem.tolerances.size(), 0.0);
  for (const auto& trial : problem.trials) point.nuisances.emplace_back(trial->nuisance_count(), 0.0);
  return point;
}

Edits edits_for(const Problem& problem, const Hypothesis& hypothesis, std::span<const double> tolerances) {
  Edits edits;
  for (std::size_t i = 0; i < hypothesis.candidates.size(); ++i) {
    const Candidate& candidate = problem.candidates[hypothesis.candidates[i]];
    candidate.effect->apply(problem.context, candidate.channel, hypothesis.values[i], edits);
  }
  for (std::size_t i = 0; i < tolerances.size(); ++i)
    if (tolerances[i] != 0.0)
      edits.sensor(problem.tolerances[i].channel, SensorEdit::Kind::delay_s,
                   tolerances[i] * problem.tolerances[i].scale);
  return edits;
}

}  // namespace sandhopper::diagnose
