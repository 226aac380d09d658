#pragma once
#include <Eigen/Core>
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

// Variance of an estimate from the scatter between trials, as a multiple of the variance that the noise alone
// gives it.
struct TrialScatter {
  double ratio = 1.0;
  double degrees_of_freedom = 0.0;
};

// The scatter pooled with the noise's own variance, as if this many degrees of freedom had shown the latter.
inline constexpr double kModelTrials = 4.0;
TrialScatter with_noise(const TrialScatter& between);

// Scatter between the scores of trials after the fit. With noise alone, the score r_t of trial t adds i_t to
// the variance of the estimate before the fit, and the covariance after it is C (trials x trials): a trial
// that determines the estimate alone is followed by it, so its score after the fit says little.
//   ratio = sum_t r_t^2 i_t / C_tt / sum_t i_t
//   degrees of freedom = (sum_t i_t)^2 / sum_ts (i_t / C_tt) (i_s / C_ss) C_ts^2
// For n equal trials these are the sample variance and n - 1. Source: Bell and McCaffrey, Survey Methodology
// 28 (2002), with Satterthwaite's degrees of freedom.
TrialScatter scatter_between(std::span<const double> scores, std::span<const double> variances,
                             const Eigen::MatrixXd& covariance);

// Evidence for the size b of an effect, trial by trial: score u_t and information I_t. The best b is sum u /
// sum I. Its variance is that of the noise, 1 / sum I, times with_noise(scatter of u_t - b I_t).
struct TrialEvidence {
  std::vector<double> score;
  std::vector<double> information;

  double total_information() const;
  double size() const;
  TrialScatter scatter() const;  // with that of the noise
  // Pearson's dispersion of quasi-likelihood, pooled with the noise: every trial counts alike.
  //   (nu0 + sum_t (u_t - b I_t)^2 / I_t) / (nu0 + T - 1),   nu0 = kModelTrials
  // Source: McCullagh and Nelder, Generalized Linear Models, 2nd ed. (1989), section 9.2.
  double dispersion() const;
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
