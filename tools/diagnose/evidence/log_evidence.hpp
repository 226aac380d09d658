#pragma once
#include <Eigen/Core>
#include <vector>

#include "tools/diagnose/evidence/limits.hpp"
#include "tools/diagnose/fit/fit.hpp"
#include "tools/diagnose/fit/linearise.hpp"

namespace sandhopper::diagnose {

// What one hypothesis, a fitted set of effects, is worth: the Laplace approximation at its fit
//   ln Z = -Phi/2 - 1/2 sum_t ln|I + C_t F_t| + sum_e ln int p(b_e) exp(-(b_e - b^_e)^2 / 2 s_e^2) db_e
//          - 1/2 ln|I + Lambda|        (shapes and tolerances, Lambda in units of their prior)
// F_t: information of trial t on the form of each effect, C its prior covariance (form, size_of_trial).
struct LogEvidence {
  double value = 0.0;
  std::vector<double> times{};  // the likeliest scale of each repeatable model error over the learned one
};

// Trials linearised at a fit, with the form of every effect eliminated: columns residual, effects'
// parameters, tolerances, `more`, repeatable error.
struct AtFit {
  std::vector<Eigen::MatrixXd> grams;
  std::vector<Eigen::MatrixXd> plain;  // the same without any error of form
  double log_determinant = 0.0;        // sum_t ln|I + C_t F_t|
};
AtFit linearised_at(const Problem& problem, const Point& point, const std::vector<Direction>& more = {});

LogEvidence log_evidence(const Problem& problem, const Fit& fit, const AtFit& at);

// Effects of a set, before anything was seen: each as likely as the next, and as many as are expected.
double log_prior(const Problem& problem, std::size_t effects);

// ln of the prior of a size b in typical ones, log-normal, times the likelihood exp(-(b - best)^2 / 2 sd^2),
// integrated over b.
double log_integral_over_size(double best, double sd, bool either_sign);

}  // namespace sandhopper::diagnose
