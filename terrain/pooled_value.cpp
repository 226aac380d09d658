#include "terrain/pooled_value.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace sandhopper {
namespace {

constexpr std::size_t kTauGrid = 200;
constexpr double kUnbounded = std::numeric_limits<double>::infinity();

using Values = std::vector<TrialValue>;

// Posterior of mu for one tau, and the weight of that tau.
struct Component {
  double tau = 0.0, mean = 0.0, variance = 0.0, weight = 0.0;
};
using Mixture = std::array<Component, kTauGrid>;

// log_weight: logarithm of the posterior of tau with mu integrated out. The grid has equal steps of ln(tau),
// which adds a factor tau.
Component component_at(const Values& trials, double tau, double& log_weight) {
  Component c{.tau = tau};
  double total = 0.0, squares = 0.0, log_density = 0.0;
  for (const auto& trial : trials) {
    const double w = 1.0 / (tau * tau + trial.sd * trial.sd);
    total += w;
    squares += w * w;
    c.mean += w * trial.value;
    log_density += 0.5 * std::log(w);
  }
  c.mean /= total;
  c.variance = 1.0 / total;
  for (const auto& trial : trials) {
    const double away = trial.value - c.mean;
    log_density -= 0.5 * away * away / (tau * tau + trial.sd * trial.sd);
  }
  log_weight = log_density - 0.5 * std::log(total) + std::log(tau) + 0.5 * std::log(squares) + std::log(tau);
  return c;
}

// The grid of tau extends four decades below and above `scale`, because the tail of the posterior is long for
// two trials.
Mixture posterior_of(const Values& trials, double scale) {
  constexpr double kDecades = 4.0;
  Mixture mixture;
  std::array<double, kTauGrid> log_weight{};
  for (std::size_t i = 0; i < kTauGrid; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(kTauGrid - 1);
    mixture[i] = component_at(trials, scale * std::pow(10.0, kDecades * (2.0 * share - 1.0)), log_weight[i]);
  }
  const double best = *std::ranges::max_element(log_weight);
  double total = 0.0;
  for (std::size_t i = 0; i < kTauGrid; ++i) total += mixture[i].weight = std::exp(log_weight[i] - best);
  for (auto& c : mixture) c.weight /= total;
  return mixture;
}

// Probability of the mixture below x, for the mean or (`further`) for a new trial.
double below(const Mixture& mixture, double x, bool further) {
  double sum = 0.0;
  for (const auto& c : mixture) {
    const double variance = c.variance + (further ? c.tau * c.tau : 0.0);
    sum += 0.5 * c.weight * std::erfc((c.mean - x) / std::sqrt(2.0 * variance));
  }
  return sum;
}

double quantile(const Mixture& mixture, double share, double centre, double scale, bool further) {
  double low = centre - scale, high = centre + scale;
  while (below(mixture, low, further) > share) low -= high - low;
  while (below(mixture, high, further) < share) high += high - low;
  constexpr int kHalvings = 50;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    (below(mixture, middle, further) < share ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

double median_tau(const Mixture& mixture) {
  double sum = 0.0;
  for (const auto& c : mixture)
    if ((sum += c.weight) >= 0.5) return c.tau;
  return mixture.back().tau;
}

// Range of the values or largest error, whichever is greater.
double scale_of(const Values& trials) {
  const auto [low, high] = std::ranges::minmax_element(trials, {}, &TrialValue::value);
  double scale = high->value - low->value;
  for (const auto& trial : trials) scale = std::max(scale, trial.sd);
  return scale;
}

}  // namespace

PooledValue pool_trials(std::span<const TrialValue> given, double shared_sd_relative) {
  constexpr double kNormal975 = 1.959964;
  Values trials;
  for (const auto& trial : given)
    if (!std::isnan(trial.value)) trials.push_back({trial.value, std::isnan(trial.sd) ? 0.0 : trial.sd});
  PooledValue out{.value = std::numeric_limits<double>::quiet_NaN(), .trials = trials.size()};
  if (trials.empty()) return out;
  const double first = trials.front().value;
  if (trials.size() == 1) return {first, -kUnbounded, kUnbounded, -kUnbounded, kUnbounded, 0.0, 1};
  const double scale = scale_of(trials);
  if (scale <= 0.0) return {first, first, first, first, first, 0.0, trials.size()};
  const auto mixture = posterior_of(trials, scale);
  out.value = 0.0;
  for (const auto& c : mixture) out.value += c.weight * c.mean;
  const double shared = kNormal975 * shared_sd_relative * out.value;
  const auto limit = [&](double share, bool further) {
    const double away = quantile(mixture, share, out.value, scale, further) - out.value;
    return out.value + std::copysign(std::hypot(away, shared), share - 0.5);
  };
  out.mean_low = limit(0.025, false);
  out.mean_high = limit(0.975, false);
  out.new_low = limit(0.025, true);
  out.new_high = limit(0.975, true);
  out.between_sd = median_tau(mixture);
  return out;
}

}  // namespace sandhopper
