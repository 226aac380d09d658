#pragma once
#include <cstddef>
#include <span>
#include <vector>

namespace sandhopper::diagnose {

// Two-sided tail probability of Student's t; 1 if t is NaN.
double student_t_two_sided(double t, double degrees_of_freedom);
// The value of t with this two-sided tail probability.
double student_t_quantile(double two_sided, double degrees_of_freedom);

// The value of a standard normal variable whose magnitude is exceeded with this probability.
double normal_quantile(double two_sided);

// A variance between trials is regularised as if this many more trials had shown the noise's own variance.
inline constexpr double kModelTrials = 4.0;
// Its degrees of freedom.
inline double degrees_of_freedom(std::size_t trials) {
  return kModelTrials + static_cast<double>(trials) - 1.0;
}

// Evidence for the size b of an effect, trial by trial: score u_t and information I_t. The best b is sum u /
// sum I. Its variance is the scatter between trials, regularised by nu0 = kModelTrials:
//   standard error = sqrt(var) / sum I,   var = (nu0 sum I + T sum (u_t - b I_t)^2) / (nu0 + T - 1)
struct TrialEvidence {
  std::vector<double> score;
  std::vector<double> information;

  double total_information() const;
  double size() const;
  double t() const;  // size / standard error
  double degrees_of_freedom() const { return diagnose::degrees_of_freedom(score.size()); }
  double p_value() const;           // for this candidate alone, not corrected for the others
  double standard_error() const;    // standard deviation of size()
  double effective_trials() const;  // (sum I)^2 / sum I^2
  // Drop of the deviance of held-out trials, each with the size from the other trials; at least 0:
  //   sum_t b_t (2 u_t - b_t I_t),   b_t = sum_{s != t} u_s / sum_{s != t} I_s
  double held_out_drop() const;
};

// Sign-flip test. The statistic is the largest |sum s_t u_t| / sqrt(sum I_t) over the candidates. Returns the
// probability that it reaches that of `chosen` for random signs s_t, which is family-wise. All 2^(T-1)
// choices of signs up to T = 12 trials, else 2,000 drawn from `seed`.
double sign_flip_p_value(const std::vector<TrialEvidence>& candidates, std::size_t chosen, unsigned seed);

// Wilcoxon's signed-rank test, exact and one-sided: probability of a rank sum of the positive values that is
// at least as large, if both signs are equally likely. Ties get no mean rank: the earlier one has the lower.
double signed_rank_p_value(const std::vector<double>& values);

// Which of these hypotheses are rejected at a false discovery rate: those whose p-value is at most that of
// the last i, by ascending p, with p_(i) <= rate i / n. Benjamini and Hochberg, J. R. Stat. Soc. B 57 (1995).
std::vector<bool> rejected_at_false_discovery_rate(const std::vector<double>& p_values, double rate);

// Median; for an even number the upper of the two middle values. 0 if empty.
double median(std::vector<double> values);

}  // namespace sandhopper::diagnose
