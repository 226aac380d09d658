#include "tools/diagnose/planned_trials.hpp"

#include <string>

namespace sandhopper::diagnose {

PlannedTrials::PlannedTrials(Problem& problem, std::vector<DoableTrial> doable)
    : problem_(&problem), first_(problem.trials.size()) {
  for (auto& one : doable) {
    std::string why;
    auto model = problem.plant->trial(one.trial, one.belief, why);
    if (!model) continue;
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

}  // namespace sandhopper::diagnose
