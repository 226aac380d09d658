#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>

#include "tools/diagnose/evidence/limits.hpp"
#include "tools/diagnose/fit/fit.hpp"
#include "tools/diagnose/fit/linearise.hpp"

namespace sandhopper::diagnose {

// Log evidence of one hypothesis (a fitted set of effects): the Laplace approximation at its fit,
//   ln Z = -d/2 - 1/2 sum_t (ln|I + C_t F_t| + ln|I + S_t Z_t'Z_t|) + sum_e ln int p(b_e) exp(-(b_e - b^_e)^2
//   / 2 s_e^2) db_e
//          - 1/2 ln|I + Lambda|        (shapes and tolerances, Lambda in units of their prior)
// d: deviance at the fit, with the priors of shapes and tolerances. F_t: information of trial t on the form
// of each law, C_t: its prior covariance (Limits::form, size_of_trial). Z_t: whitened derivatives of
// trial t by its nuisances at this fit, S_t: their prior variances. Mean over Limits::form_shares of C_t.
struct LogEvidence {
  double value = 0.0;
  std::vector<double> times{};  // Most probable ratio of each repeatable model error to its learnt scale.
};

// Gram matrices of the trials linearised at a fit. Columns: residual, effects' parameters, tolerances,
// `more`, repeatable error.
struct AtFit {
  // With the form error of every law eliminated.
  struct Formed {
    std::vector<Eigen::MatrixXd> grams;
    std::vector<double> log_determinants;  // ln|I + C_t F_t| + ln|I + S_t Z_t'Z_t| of each trial
  };
  std::vector<Formed> formed;          // One for each of `form_shares`; only one if there is no law.
  std::vector<Eigen::MatrixXd> plain;  // Without form errors.
};
AtFit linearised_at(const Problem& problem, const Point& point, const std::vector<Direction>& more = {},
                    std::span<const double> form_shares = kLimits.form_shares);

// Log evidence of a fit; `at`: linearised at its point.
LogEvidence log_evidence(const Problem& problem, const Fit& fit, const AtFit& at);
// The same with each trial counted so many times, for several such weightings (columns of `weights`, one row
// for each trial). The ratios of the repeatable model errors stay those of equal weights.
std::vector<double> weighted_log_evidence(const Problem& problem, const Fit& fit, const AtFit& at,
                                          const Eigen::MatrixXd& weights);
// The log evidence for each of the form errors by itself.
std::vector<LogEvidence> log_evidence_by_form(const Problem& problem, const Fit& fit, const AtFit& at);

// Log prior of a set: the listed effects are equally probable, Limits::effects_expected of them are expected
// to be missing. The second part is that of effects which contradict [known_to]: Limits::statement_wrong
// each.
double log_prior(const Problem& problem, const std::vector<std::size_t>& set);
double log_prior_of_statements(const Problem& problem, const std::vector<std::size_t>& set);

// ln int p(b) exp(-(b - best)^2 / 2 sd^2) db for the size b of an effect in typical sizes. p: log-normal
// around 1 with standard deviation Limits::size_spread, split over both signs if `either_sign`.
double log_integral_over_size(double best, double sd, bool either_sign);

}  // namespace sandhopper::diagnose
