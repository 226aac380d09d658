#pragma once
#include <Eigen/Core>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "tools/diagnose/problem.hpp"

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
// Rows of channels that are off by more than their noise have the weight of GroupedDeviance.
struct TrialLinear {
  Eigen::MatrixXd gram;
  double log_determinant = 0.0;  // ln|I + S Z'Z|
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
// The same along each of the problem's `form_knots`, of a coordinate: what all trials share.
inline constexpr Eigen::Index kSharedFormKnots = 6;

struct LineariseOptions {
  // kFormKnots columns each, after the directions, then those that trials share.
  const std::vector<FormOf>* forms = nullptr;
  const std::vector<Eigen::MatrixXd>* more = nullptr;  // of every trial: plain derivatives, after the forms
  bool with_repeatable_error = false;                  // its columns last
  bool with_own_error = false;                         // and after them those of this trial alone
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

// Deviance of a trial whose channels may be noisier than they should be: the noise of group g, a channel in a phase,
// is lambda_g >= 1 times the sensor's, lambda_g^2 = max(1, S_g / n_g) being likeliest, with S_g the sum of its n_g
// whitened squares, of which tau say no more than one:
//   rho = sum_g S_g / tau                     where S_g <= n_g
//         n_g / tau (1 + ln S_g/n_g)  elsewhere
// Its derivative by a square is the weight 1 / (tau lambda_g^2); rho lies below its tangent in the squares, so that
// a step that lowers the weighted squares lowers rho by at least as much (Hunter and Lange 2004,
// majorise-minimise).
struct GroupedDeviance {
  double rho = 0.0, weighted = 0.0;
  Eigen::VectorXd root_weight;  // of each row
};
GroupedDeviance grouped_deviance(const Problem& problem, std::size_t trial, const Eigen::VectorXd& whitened);

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
// Whitens the kept ones with the noise model as it is now.
void whiten_kept_columns(Problem& problem);

}  // namespace sandhopper::diagnose
