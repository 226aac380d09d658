#pragma once
#include <cstddef>
#include <span>

// Pools one quantity of the ground over several trials, with the trial as the unit. Trial i gives y_i with
// its own standard deviation s_i. The trials' true values are normal around a mean,
//   y_i ~ N(mu, tau^2 + s_i^2),  mu unknown, tau unknown with the reference prior
//   p(tau) ~ tau sqrt(sum w_i^2),  w_i = 1/(tau^2 + s_i^2)
// (Bodnar et al. 2017). With s_i = 0 that is Student's interval with n - 1 degrees of freedom. For one tau
//   mu | tau ~ N(sum w_i y_i / W, 1/W),  W = sum w_i,   a new trial | tau ~ the same with tau^2 + 1/W
// and both intervals are quantiles over the posterior of tau, on a grid.
// An error that all trials share (a force scale, a mass) does not average out. Its part, relative to the
// value, is added to both intervals in quadrature.
namespace sandhopper {

struct TrialValue {
  double value;
  double sd = 0.0;
};

struct PooledValue {
  double value = 0.0;
  double mean_low = 0.0, mean_high = 0.0;  // 95 % interval of the mean
  double new_low = 0.0, new_high = 0.0;    // 95 % interval of one new trial's true value
  double between_sd = 0.0;                 // posterior median of tau
  std::size_t trials = 0;
};

// NaN values are ignored. With one trial both intervals are infinite, because the difference between trials
// is unknown. Without any trial the value is NaN.
PooledValue pool_trials(std::span<const TrialValue> trials, double shared_sd_relative = 0.0);

}  // namespace sandhopper
