#include "tools/diagnose/next/planned_trials.hpp"

#include "tools/diagnose/fit/fit.hpp"

namespace sandhopper::diagnose {

PlannedTrials::PlannedTrials(Problem& problem, std::vector<DoableTrial> doable)
    : problem_(&problem), first_(problem.trials.size()) {
  for (auto& one : doable) {
    std::string why;
    auto model = problem.plant->trial(one.trial, one.belief, why);
    if (!model) {
      if (refusal_.empty()) refusal_ = why;
      continue;
    }
    model->add_key_spreads(one.belief);
    for (auto& row : model->rows) row.measured = 0.0;
    problem.used.emplace_back(model->rows.size(), std::uint8_t{1});
    problem.trials.push_back(std::move(model));
    doable_.push_back(std::move(one));
  }
}

PlannedTrials::~PlannedTrials() {
  problem_->trials.resize(first_);
  problem_->used.resize(first_);
}

TrialLinear PlannedTrials::linearised(std::size_t i, const Edits& base,
                                      const std::vector<Direction>& directions, bool keep_plain) const {
  const std::vector<double> zero(model(i).nuisance_count(), 0.0);
  return linearise(*problem_, first_ + i, base, zero, directions,
                   {.keep_plain = keep_plain, .fresh_columns = true});
}

std::vector<Direction> plain_directions(const Problem& problem, const Point& point) {
  constexpr double kStep = 0.1;  // in scales of the tolerance
  auto directions = parameter_directions(problem, point);
  const std::size_t first = directions.size() - point.tolerances.size();
  for (std::size_t i = 0; i < point.tolerances.size(); ++i) {
    auto moved = point.tolerances;
    moved[i] += kStep;
    directions[first + i] = {edits_for(problem, point.hypothesis, moved), kStep};
  }
  return directions;
}

}  // namespace sandhopper::diagnose
