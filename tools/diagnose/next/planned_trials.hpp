#pragma once
#include <Eigen/Core>
#include <vector>

#include "tools/diagnose/fit/linearise.hpp"
#include "tools/diagnose/fit/problem.hpp"

namespace sandhopper::diagnose {

// Trials that were not recorded, put beside a problem's own so that they can be linearised like them.
class PlannedTrials {
 public:
  PlannedTrials(Problem& problem, std::vector<DoableTrial> doable);
  ~PlannedTrials();
  PlannedTrials(const PlannedTrials&) = delete;
  PlannedTrials& operator=(const PlannedTrials&) = delete;

  std::size_t size() const { return doable_.size(); }
  const DoableTrial& operator[](std::size_t i) const { return doable_[i]; }
  const TrialModel& model(std::size_t i) const { return *problem_->trials[first_ + i]; }

  // As linearise(), nuisances at zero. Column 0 is minus the prediction at `base`.
  TrialLinear linearised(std::size_t i, const Edits& base, const std::vector<Direction>& directions,
                         bool keep_plain = false) const;

 private:
  Problem* problem_;
  std::size_t first_;
  std::vector<DoableTrial> doable_;
};

// As parameter_directions(), tolerances simulated like the others: a kept column is the derivative at the
// point of the linearisation, not a difference to it.
std::vector<Direction> plain_directions(const Problem& problem, const Point& point);

}  // namespace sandhopper::diagnose
