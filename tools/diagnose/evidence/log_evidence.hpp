#pragma once
#include <Eigen/Core>
#include <limits>
#include <optional>
#include <vector>

#include "tools/diagnose/evidence/limits.hpp"
#include "tools/diagnose/fit.hpp"
#include "tools/diagnose/linearise.hpp"
#include "tools/diagnose/statistics.hpp"

namespace sandhopper::diagnose {

// How much larger model error is in one campaign than its learned scale: half-normal, optimised.
struct ErrorScales {
  std::vector<double> repeatable;  // of each group of repeatable errors; 0: it is not there
  std::vector<double> form;        // of each effect: of its law, the same in all trials
  std::vector<double> of_trial;    // of each effect: of its form and size, trial by trial; last: of forces
  double law = 1.0;                // of a fitted law's knots, in scales of its port
};

// Whether a law of free form is larger than model error.
bool is_unknown(const Problem& problem, const ErrorScales& scales, std::size_t group);

// What one hypothesis, a fitted set of effects, is worth: the Laplace approximation at its fit
//   ln Z = -Phi/2 - 1/2 sum_t ln|I + C_t F_t| + sum_e ln int p(b_e) exp(-(b_e - b^_e)^2 / 2 s_e^2) db_e
//          - 1/2 ln|I + Lambda|        (shapes, tolerances and errors, Lambda in units of their prior)
// F_t: information of trial t on the form of each effect, C its prior covariance (form, size_of_trial).
struct LogEvidence {
  double value = 0.0;
  // The same with a group of repeatable errors that is larger than model error: an unknown law.
  double with_unknown = -std::numeric_limits<double>::infinity();
  std::size_t unknown = 0;  // which
  ErrorScales scales{};
  double deviance = 0.0;              // with model error of the effects' form taken up
  Eigen::MatrixXd covariance;         // of the effects' parameters, in typical sizes
  std::vector<TrialEvidence> trials;  // of each effect, one number a trial
};

// Trials linearised at a fit: columns residual, effects' parameters, tolerances, `more`, forms that trials
// share, repeatable errors, then forms and errors of this trial alone; the last three in standard deviations.
struct AtFit {
  std::vector<Eigen::MatrixXd> trials;
  double log_determinant = 0.0;  // of the nuisances, sum_t ln|I + S Z'Z|
  Eigen::Index directions = 0, more = 0, shared_forms = 0, repeatable = 0, effects = 0;

  Eigen::Index shared() const { return 1 + directions + more + shared_forms + repeatable; }
};
AtFit linearised_at(const Problem& problem, const Point& point, const std::vector<KeptColumns>* columns,
                    const std::vector<Eigen::MatrixXd>* more = nullptr);

// The forms of each trial eliminated: sum over the trials of ln|I + C_t F_t| and what is left of the columns.
struct WithoutForms {
  std::vector<Eigen::MatrixXd> grams;
  double log_determinant = 0.0;
};
WithoutForms without_forms(const AtFit& at, const std::vector<double>& of_trial);

// 1 / variance of the forms that trials share, then of the repeatable errors.
Eigen::VectorXd error_information(const Problem& problem, const Hypothesis& hypothesis, const AtFit& at,
                                  const ErrorScales& scales);

LogEvidence log_evidence(const Problem& problem, const Fit& fit, const AtFit& at);

// Effects of a set, before anything was seen: each as likely as the next, and as many as are expected.
double log_prior(const Problem& problem, std::size_t effects);

// ln of the prior of a size b in typical ones, log-normal, times the likelihood exp(-(b - best)^2 / 2 sd^2),
// integrated over b.
double log_integral_over_size(double best, double sd, bool either_sign);

}  // namespace sandhopper::diagnose
