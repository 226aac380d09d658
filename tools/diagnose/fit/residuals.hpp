#pragma once
#include <Eigen/Core>
#include <vector>

#include "tools/diagnose/discrepancy/free_laws.hpp"
#include "tools/diagnose/evidence/search.hpp"

namespace sandhopper::diagnose {

// Recorded minus simulated for every row of every trial, with the trial's own nuisances fitted.
struct Residuals {
  std::vector<Eigen::VectorXd> before;    // with the belief
  std::vector<Eigen::VectorXd> after;     // with the effects that were found
  std::vector<Eigen::VectorXd> held_out;  // the same, with sizes from the other trials only
  // [trial]: change of the rows by all that was found, with the nuisances of the answer; 0 if nothing was.
  std::vector<Eigen::VectorXd> found;
  std::vector<std::vector<Eigen::VectorXd>>
      change;  // [trial][effect of the best set]: change of the rows by that effect
};

// Residuals of the belief alone, for an answer without findings: `after` and `held_out` equal `before`.
Residuals residuals_of_belief(const Problem& problem, const Point& null);

// Residuals at `null` (as believed) and at `point`: the answer, perhaps with a law of free form.
Residuals residuals_of(const Problem& problem, const Point& null, const Point& point);

// Drop of the squared residuals of held-out trials against the belief: sum over rows of (before^2 -
// held_out^2) / sd^2. It is not whitened, because whitening hides slow drifts. The drop of the prior terms of
// nuisances with `shift_is_evidence` is added: a bed that grows stiffer from trial to trial shows only there.
double held_out_gain(const Problem& problem, const Residuals& residuals, const Point& null,
                     const Point& point);

}  // namespace sandhopper::diagnose
