#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <vector>

#include "tools/diagnose/fit/linearise.hpp"
#include "tools/diagnose/fit/problem.hpp"

namespace sandhopper::diagnose {

// at_bound: converged with the first parameter of an effect at one of its bounds.
enum class FitStatus : std::uint8_t { converged, at_bound, failed };

// Prior of an amplitude: standard deviation in typical sizes, and its information.
inline constexpr double kPriorTypicals = 10.0;
inline constexpr double kPriorOfAmplitude = 1.0 / (kPriorTypicals * kPriorTypicals);

// Joint fit of effects, tolerances and all nuisances (zeta) through the simulation. Levenberg-Marquardt
// minimises
//   Phi = 1/2 sum_t |W (y - yhat)|^2 + 1/2 |beta / (10 typical)|^2 + 1/2 |tolerance|^2
//         + 1/2 sum |zeta / sd|^2
// Shape parameters have the prior ((beta - typical) / typical)^2 instead, and a free law that of
// free_law_information(). A step is accepted if the simulation at the new point lowers Phi.
struct Fit {
  Point point;
  FitStatus status = FitStatus::failed;
  double deviance = 0.0;               // 2 Phi
  std::vector<double> trial_deviance;  // without the priors of effects and tolerances
  // Information matrix of the parameters in the order of parameter_directions(), with their priors and with
  // the nuisances eliminated.
  Eigen::MatrixXd information;
  int iterations = 0;
  double promised = 0.0;  // predicted minus actual drop of the deviance in the last step
};

struct FitOptions {
  int max_iterations = 24;
  double tolerance = 0.1;  // the fit ends when a step lowers the deviance by less than this
  // Least predicted drop of a trial's deviance for a step of that trial's nuisances alone.
  double own_gain = 0.1;
  bool refresh = true;  // recompute the derivatives by nuisances when steps gain too little
  // Derivatives by nuisances to begin with; null: Problem::kept_columns.
  const std::vector<KeptColumns>* columns = nullptr;
  bool columns_made_here = false;  // these derivatives were computed at `start`
  // The nuisances of a trial move only if that is predicted to lower its deviance by this share of (deviance
  // - number of rows).
  double far_gain = 0.0;
  // The fit is given up if the deviance would stay above this even if each remaining iteration gained twice
  // the last gain.
  double of_use_below = std::numeric_limits<double>::infinity();
};

// Fits from `start`, with its nuisances and tolerances as starting values.
Fit fit_from(const Problem& problem, const Point& start, const FitOptions& options = {});

// The free parameters of a point as directions for linearise(), in this order: parameters of the effects (in
// typical sizes), sizes of the free law's terms, tolerances.
std::vector<Direction> parameter_directions(const Problem& problem, const Point& point);
// Moves these parameters by `step`, in the same order, and clamps them to their bounds. Returns true if the
// first parameter of an effect met a bound.
bool move_parameters(const Problem& problem, Point& point, const Eigen::VectorXd& step);
// Adds the priors of these parameters to an information matrix and a score.
void add_priors(const Problem& problem, const Point& point, Eigen::MatrixXd& information,
                Eigen::VectorXd& score);
// Part of the deviance (2 Phi) that comes from these priors.
double prior_deviance(const Problem& problem, const Point& point);
// Diagonal prior information of the effects' parameters and the tolerances, without a free law. A tolerance
// at its bound gets 1e12, so that it stays fixed.
Eigen::VectorXd prior_information(const Problem& problem, const Point& point);

}  // namespace sandhopper::diagnose
