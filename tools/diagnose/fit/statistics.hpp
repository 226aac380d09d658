#pragma once
#include <cstddef>
#include <span>
#include <vector>

namespace sandhopper::diagnose {

// Two-sided tail probability of Student's t; 1 where t is no number.
double student_t_two_sided(double t, double degrees_of_freedom);
// Value that a two-sided probability belongs to.
double student_t_quantile(double two_sided, double degrees_of_freedom);

// One number of evidence per trial: score u_t and information I_t of an effect's size b, whose best value is
// sum u / sum I. Its variance is taken between trials, held up by what the noise alone would give as if that
// came from `kModelTrials` trials more:
//   var = (nu0 sum I + sum (u_t - b I_t)^2 T) / (nu0 + T - 1)
struct TrialEvidence {
  std::vector<double> score;
  std::vector<double> information;

  double size() const;
  double t() const;  // of size / its error
  double degrees_of_freedom() const;
  double p_value() const;           // one candidate alone
  double standard_error() const;    // of size
  double effective_trials() const;  // (sum I)^2 / sum I^2
  // Drop of the deviance of trials that the size was not fitted to, each taking it from the others:
  //   sum_t b_t (2 u_t - b_t I_t),   b_t = sum_{s != t} u_s / sum_{s != t} I_s
  double held_out_drop() const;
};

// Largest |sum s_t u_t| / sqrt(sum I_t) over candidates, for every choice of signs s_t (all of them up to
// 2^11, else 2,000 drawn from `seed`): how often it reaches that of `chosen`. The family-wise probability
// that trials agree by chance.
double sign_flip_p_value(const std::vector<TrialEvidence>& candidates, std::size_t chosen, unsigned seed);

// Wilcoxon's signed-rank test, exact, one-sided: how often the ranks of positive values sum to as much if
// every sign is as likely as the other. Ties share no rank: the earlier one has the lower.
double signed_rank_p_value(const std::vector<double>& values);

// The upper of two in the middle; 0 of none.
double median(std::vector<double> values);

}  // namespace sandhopper::diagnose
