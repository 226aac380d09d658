#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <vector>

#include "tools/diagnose/fit/linearise.hpp"
#include "tools/diagnose/fit/problem.hpp"

namespace sandhopper::diagnose {

enum class FitStatus : std::uint8_t { converged, at_bound, failed };

// A joint fit of effects, tolerances and all nuisances through the simulation:
//   Phi = 1/2 sum_t |W (y - yhat)|^2 + 1/2 |(beta / (10 typical))|^2 + 1/2 |tolerance|^2 + 1/2 sum |zeta /
//   sd|^2
// by Levenberg-Marquardt; a step counts when simulating it again lowers Phi.
struct Fit {
  Point point;
  FitStatus status = FitStatus::failed;
  double deviance = 0.0;               // 2 Phi
  std::vector<double> trial_deviance;  // without the priors of effects and tolerances
  // Of effects' parameters (scaled by typical), sizes of a free law's terms, tolerances.
  Eigen::MatrixXd information;
  int iterations = 0;
  double promised = 0.0;  // drop of the deviance that the last step hoped for and did not bring
};

struct FitOptions {
  int max_iterations = 24;
  double tolerance = 0.1;  // of the deviance: less gain than this ends the fit
  bool refresh = true;     // once steps fall short, go on with derivatives by the nuisances made there
  const std::vector<KeptColumns>* columns = nullptr;  // until then; the problem's own where not given
  bool columns_made_here = false;                     // at `start`
  // Of what a trial is off beyond its rows: nuisances that would follow for less stay.
  double far_gain = 0.0;
  // Of the deviance: what could not come below it if each iteration left gained twice what the last one did
  // is given up.
  double of_use_below = std::numeric_limits<double>::infinity();
};

// From `start`; its nuisances and tolerances are kept as starting values.
Fit fit_from(const Problem& problem, const Point& start, const FitOptions& options = {});

// Directions of the free parameters of a point: effects', each scaled by its typical size, sizes of a free
// law's terms, tolerances.
std::vector<Direction> parameter_directions(const Problem& problem, const Point& point);
// What is believed of them beforehand, added to a fit's information and to its score.
void add_priors(const Problem& problem, const Point& point, Eigen::MatrixXd& information,
                Eigen::VectorXd& score);
// 2 Phi of these priors.
double prior_deviance(const Problem& problem, const Point& point);
// Their information beforehand, without a law. A tolerance that has gone as far as it may is none any more:
// it is held.
Eigen::VectorXd prior_information(const Problem& problem, const Point& point);

}  // namespace sandhopper::diagnose
