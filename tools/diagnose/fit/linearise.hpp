#pragma once
#include <Eigen/Core>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "tools/diagnose/fit/problem.hpp"

namespace sandhopper::diagnose {

// A direction in which the simulation may change: prediction(edits) - prediction, divided by `step`.
struct Direction {
  Edits edits;
  double step = 1.0;
  int tolerance = -1;  // where it is one of the problem's tolerances: its column may be a kept one
};

// One trial at one point: whitened residual in column 0 and one whitened derivative per direction after it,
// with the trial's nuisances integrated out under their priors.
//   gram  = X'X - X'Z (Z'Z + S^-1)^-1 Z'X,   X = [r, directions], Z nuisances, S prior variances
// so gram(0,0) is the trial's deviance, gram(0,i) the score of direction i, gram(i,j) its information.
struct TrialLinear {
  Eigen::MatrixXd gram;
  Eigen::VectorXd residual;  // plain, as recorded minus predicted
  Eigen::MatrixXd solution;  // change of every nuisance per column of X: dz = s_0 - sum_i s_i b_i
  Eigen::MatrixXd plain;  // derivatives as they are, and what the nuisances then do; empty unless asked for
};

// The signature of something that acts, cut into overlapping stretches of time: hat functions that sum to one
// times sum_i weight_i direction_i. What its law has another form by, or its size in one trial, lies along
// these.
struct FormOf {
  std::vector<std::pair<std::size_t, double>> directions;  // index into them, weight
};
inline constexpr Eigen::Index kFormKnots = 8;

struct LineariseOptions {
  const std::vector<FormOf>* forms = nullptr;          // kFormKnots columns each, after the directions
  const std::vector<Eigen::MatrixXd>* more = nullptr;  // of every trial: plain derivatives, after the forms
  bool with_repeatable_error = false;                  // its columns last
  bool keep_plain = false;
  bool fresh_columns = false;                         // do not take the kept ones
  const std::vector<KeptColumns>* columns = nullptr;  // take these, one for every trial
  const Eigen::VectorXd* prediction = nullptr;        // known already
  double damping = 0.0;   // of the nuisances: their diagonal grows by this share (Marquardt)
  std::size_t every = 1;  // of linearise_all: which trials, from the first
};

TrialLinear linearise(const Problem& problem, std::size_t trial, const Edits& base,
                      const std::vector<double>& nuisances, const std::vector<Direction>& directions,
                      const LineariseOptions& options = {});

// All trials (or every nth), in parallel.
std::vector<TrialLinear> linearise_all(const Problem& problem, const Point& point,
                                       const std::vector<Direction>& directions,
                                       const LineariseOptions& options = {});

// One trial's prediction; where it is not finite, a number that is far from everything.
Eigen::VectorXd predicted(const Problem& problem, const TrialModel& trial, const Edits& edits,
                          const std::vector<double>& nuisances);

// As recorded minus a prediction.
Eigen::VectorXd residual_of(const TrialModel& trial, const Eigen::VectorXd& prediction);

// What the rows of these channels have of the deviance at this point.
double deviance_of(const Problem& problem, const Point& point, const std::vector<std::string>& channels);

// The derivatives by nuisances and tolerances at this point, whitened with the noise model as it is now.
std::vector<KeptColumns> columns_at(const Problem& problem, const Point& point);

// The same of one trial.
KeptColumns columns_of(const Problem& problem, std::size_t trial, const Edits& base,
                       const std::vector<double>& nuisances);

// Keeps them for what follows.
void keep_columns(Problem& problem, const Point& point);

}  // namespace sandhopper::diagnose
