#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "tools/diagnose/fit/linearise.hpp"
#include "tools/diagnose/fit/problem.hpp"

namespace sandhopper::diagnose {

// Trials that were not recorded, appended to a problem's trials so that they can be linearised in the same
// way. The destructor removes them.
class PlannedTrials {
 public:
  PlannedTrials(Problem& problem, std::vector<DoableTrial> doable);
  ~PlannedTrials();
  PlannedTrials(const PlannedTrials&) = delete;
  PlannedTrials& operator=(const PlannedTrials&) = delete;

  std::size_t size() const { return doable_.size(); }
  // The plant's reason for the first trial that cannot be simulated; empty if all can.
  const std::string& refusal() const { return refusal_; }
  const DoableTrial& operator[](std::size_t i) const { return doable_[i]; }
  const TrialModel& model(std::size_t i) const { return *problem_->trials[first_ + i]; }

  // Like linearise(), with all nuisances at zero. Column 0 is minus the prediction at `base`.
  TrialLinear linearised(std::size_t i, const Edits& base, const std::vector<Direction>& directions,
                         bool keep_plain = false) const;

 private:
  Problem* problem_;
  std::size_t first_;
  std::vector<DoableTrial> doable_;
  std::string refusal_;
};

// Like parameter_directions(), but tolerances are simulated, too: their kept derivatives belong to the point
// of the linearisation, and here the points differ.
std::vector<Direction> plain_directions(const Problem& problem, const Point& point);

}  // namespace sandhopper::diagnose
