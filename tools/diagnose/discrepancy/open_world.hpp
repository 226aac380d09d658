#pragma once
#include <vector>

#include "tools/diagnose/discrepancy/free_laws.hpp"
#include "tools/diagnose/evidence/screen.hpp"
#include "tools/diagnose/fit/fit.hpp"

namespace sandhopper::diagnose {

// Gain of a law of free form, beside the effects of a point, on trials it was not fitted to.
struct FreeGain {
  FreeFamily family;
  double held_out = 0.0;       // Drop of the deviance; from `laws_of_balances`, a fraction of the variance.
  double trials_better = 0.0;  // fraction of the trials that improve
  double p_value = 1.0;        // One-sided Student's t over trials, Bonferroni-corrected for all families.
  Eigen::VectorXd size;
  Eigen::VectorXd sd;
};

// One-sided p-value that the mean of the gains is positive, by Student's t over the signed square roots of
// the trials' gains. `spread`: prior standard deviation of these square roots.
double p_of_gains(const std::vector<double>& gains, double spread);

// All families, the largest gain first (laws of sensors count 3/4).
std::vector<FreeGain> free_gains(const Problem& problem, const Point& point);

// Fits the law together with everything else at `at` through the simulation. Writes the fitted sizes and
// their standard deviations to `law`. Returns the point of `at` if no fit improves on it.
Point with_law_fitted(const Problem& problem, const Fit& at, FreeGain& law);

}  // namespace sandhopper::diagnose
