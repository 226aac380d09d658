#pragma once
#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tools/diagnose/fit/problem.hpp"

namespace sandhopper::diagnose {

// A direction in which the simulation may change. Its derivative is (prediction(edits) - prediction) / step,
// or (prediction(edits) - prediction(opposite)) / (2 step) if there is an opposite.
struct Direction {
  Edits edits;
  double step = 1.0;
  int tolerance = -1;  // >= 0: index of a tolerance; its derivative is a kept column
  std::optional<Edits> opposite{};
  // Label of an effect whose first parameter changes by `like_step`: in a trial with a nuisance that acts
  // alike
  // (`TrialModel::like`) the derivative is the nuisance's, times `like_step` and its change per unit.
  std::string like{};
  double like_step = 0.0;
};

// The derivative that stands for a direction's in a trial, out of the nuisances' columns; none: simulate it.
std::optional<Eigen::VectorXd> derivative_of_alike(const Problem& problem, std::size_t trial,
                                                   const Direction& direction, const KeptColumns& kept);

// Derivative in a direction; `simulate(edits)` gives a prediction, `centre` is the one without the change.
template <class Simulate>
Eigen::VectorXd derivative(const Direction& direction, const Eigen::VectorXd& centre,
                           const Simulate& simulate) {
  const Eigen::VectorXd above = simulate(direction.edits);
  if (!direction.opposite) return (above - centre) / direction.step;
  return (above - simulate(*direction.opposite)) / (2.0 * direction.step);
}

// Linear model of one trial at one point. X holds the whitened residual r, then one whitened derivative per
// direction. The trial's nuisances are eliminated under their priors:
//   gram  = X'X - X'Z (Z'Z + S^-1)^-1 Z'X,   X = [r, directions], Z nuisances, S prior variances
// gram(0,0) is the trial's deviance at the best nuisances, gram(0,i) the score of direction i, and gram(i,j)
// the information.
struct TrialLinear {
  Eigen::MatrixXd gram;
  Eigen::VectorXd residual;  // recorded minus predicted, not whitened
  // Per column of X: change s of the nuisances; for sizes b_i it is s_0 - sum_i s_i b_i.
  Eigen::MatrixXd solution;
  // Columns of X, not whitened, less what the nuisances take up; empty unless asked for.
  Eigen::MatrixXd plain;
  double log_determinant = 0.0;  // ln |I + S^1/2 Z'Z S^1/2|, if nothing was damped
};

// A signature, sum_i weight_i direction_i, times hat functions of time that sum to one. These columns
// describe an error in the form of an effect's law, or in its size in one trial.
struct FormOf {
  std::vector<std::pair<std::size_t, double>> directions;  // index of a direction, weight
};
inline constexpr Eigen::Index kFormKnots = 8;  // hat functions of one form

struct LineariseOptions {
  const std::vector<FormOf>* forms = nullptr;  // kFormKnots columns each, after the directions
  // Per trial: more derivatives, not whitened; their columns follow the forms.
  const std::vector<Eigen::MatrixXd>* more = nullptr;
  bool with_repeatable_error = false;                 // adds the columns of Problem::repeatable_error last
  bool keep_plain = false;                            // fill TrialLinear::plain
  bool fresh_columns = false;                         // recompute the derivatives by nuisances
  const std::vector<KeptColumns>* columns = nullptr;  // derivatives by nuisances to use, one entry per trial
  const Eigen::VectorXd* prediction = nullptr;        // the prediction at this point, if known
  double damping = 0.0;   // Marquardt damping of the nuisances: their diagonal grows by this share
  std::size_t every = 1;  // only for linearise_all: every nth trial, from the first
};

// Linearises one trial at the edits `base` and its nuisances.
TrialLinear linearise(const Problem& problem, std::size_t trial, const Edits& base,
                      const std::vector<double>& nuisances, const std::vector<Direction>& directions,
                      const LineariseOptions& options = {});

// All trials (or every nth), in parallel.
std::vector<TrialLinear> linearise_all(const Problem& problem, const Point& point,
                                       const std::vector<Direction>& directions,
                                       const LineariseOptions& options = {});

// Prediction of one trial; values that are not finite become 1e6. Counts as one simulation.
Eigen::VectorXd predicted(const Problem& problem, const TrialModel& trial, const Edits& edits,
                          const std::vector<double>& nuisances);

// Recorded minus predicted.
Eigen::VectorXd residual_of(const TrialModel& trial, const Eigen::VectorXd& prediction);

// Derivatives of all trials by tolerances and nuisances at this point, whitened with the present noise model.
std::vector<KeptColumns> columns_at(const Problem& problem, const Point& point);

// The same for one trial.
KeptColumns columns_of(const Problem& problem, std::size_t trial, const Edits& base,
                       const std::vector<double>& nuisances);

// Stores columns_at(point) in Problem::kept_columns.
void keep_columns(Problem& problem, const Point& point);

}  // namespace sandhopper::diagnose
