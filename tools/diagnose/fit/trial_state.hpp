#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "tools/diagnose/fit/problem.hpp"

namespace sandhopper::diagnose {

// State of one trial at a point: nuisances, their prediction, and the deviance with the nuisances' prior.
struct TrialState {
  std::vector<double> nuisances;
  Eigen::VectorXd prediction;
  double deviance = 0.0;
};

// Simulates the trial with these nuisances and fills in prediction and deviance.
void evaluate(const Problem& problem, std::size_t trial, const Edits& edits, TrialState& state);

}  // namespace sandhopper::diagnose
