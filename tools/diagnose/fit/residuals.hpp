#pragma once
#include <Eigen/Core>
#include <vector>

#include "tools/diagnose/discrepancy/free_laws.hpp"
#include "tools/diagnose/evidence/search.hpp"

namespace sandhopper::diagnose {

// Recorded minus simulated for every row of every trial, the trial's own nuisances fitted.
struct Residuals {
  std::vector<Eigen::VectorXd> before;    // as believed
  std::vector<Eigen::VectorXd> after;     // with what was found
  std::vector<Eigen::VectorXd> held_out;  // the same, its sizes from the other trials
  std::vector<std::vector<Eigen::VectorXd>>
      change;  // [trial][effect of the best set]: what it does to the rows
};

// `point`: the answer, perhaps with a law of free form.
Residuals residuals_of(const Problem& problem, const Point& null, const Point& point);

// By how much the trials, each left out of what is fitted, are nearer to `residuals.held_out` than to what is
// believed: sum over rows of squares, in standard deviations. Not whitened: that hides what drifts apart
// slowly. And by how much less trials then differ in what they are believed to differ by: a bed that grows
// stiffer from trial to trial shows in nothing else.
double held_out_gain(const Problem& problem, const Residuals& residuals, const Point& null,
                     const Point& point);

}  // namespace sandhopper::diagnose
