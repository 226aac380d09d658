#include "tools/calibrate/still.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace sandhopper::calibrate {
namespace {

constexpr std::size_t kStretches = 10;
using Means = std::array<double, kStretches>;

double mean_of(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double squares_about(std::span<const double> values, double centre) {
  return std::accumulate(values.begin(), values.end(), 0.0,
                         [&](double sum, double v) { return sum + (v - centre) * (v - centre); });
}

// Share of the means' scatter that the best single step explains.
double share_of_step(const Means& means) {
  const double total = squares_about(means, mean_of(means));
  double least = total;
  for (std::size_t k = 1; k < kStretches; ++k) {
    const auto low = std::span(means).first(k), high = std::span(means).subspan(k);
    least = std::min(least, squares_about(low, mean_of(low)) + squares_about(high, mean_of(high)));
  }
  return 1.0 - least / total;
}

double share_of_line(const Means& means) {
  const double centre = mean_of(means), middle = (kStretches - 1) / 2.0;
  double along = 0.0, spread = 0.0;
  for (std::size_t k = 0; k < kStretches; ++k) {
    const double x = static_cast<double>(k) - middle;
    along += x * (means[k] - centre);
    spread += x * x;
  }
  return along * along / spread / squares_about(means, centre);
}

Refusal of_wander(const StillMean& mean, const Means& means, const StillLimits& limits,
                  const std::string& what) {
  const auto found = fmt::format("{} changed by {:.3g} within {:.1f} s, allowed {:.3g} and noise", what,
                                 mean.wander, mean.duration_s, limits.max_wander);
  // A line explains 97 % of the variance of a ramp and 75 % of a step. A step explains 75 % of a ramp.
  const double step = share_of_step(means), line = share_of_line(means);
  if (step > 0.85 && step > line)
    return {"slipped", found + ": it jumped",
            "see that nothing slips or is touched meanwhile, and record again"};
  if (line > 0.85)
    return {"drifting", found + ": it drifts",
            "let sensor and amplifier warm up for 15 minutes, and record again"};
  return {"moving", found + ": it moves", "support it so that it stands still, and record again"};
}

}  // namespace

StillMean still_mean(const Series& series, const StillLimits& limits, const std::string& what,
                     std::vector<Refusal>& refusals) {
  StillMean out;
  out.samples = series.size();
  out.duration_s = series.size() > 1 ? series.time_s.back() - series.time_s.front() : 0.0;
  if (out.samples < std::max(limits.min_samples, 2 * kStretches) || out.duration_s < limits.min_duration_s) {
    refusals.push_back(
        {"too_few_samples",
         fmt::format("{}: {} samples in {:.2f} s, at least {} in {} s are needed", what, out.samples,
                     out.duration_s, limits.min_samples, limits.min_duration_s),
         "record for longer; if there is nothing at all, `hop doctor` says whether the sensor delivers"});
    return out;
  }
  out.value = mean_of(series.value);
  Means means;
  double within = 0.0;
  for (std::size_t k = 0; k < kStretches; ++k) {
    const std::size_t from = k * out.samples / kStretches, to = (k + 1) * out.samples / kStretches;
    const auto stretch = std::span(series.value).subspan(from, to - from);
    means[k] = mean_of(stretch);
    within += squares_about(stretch, means[k]);
  }
  out.noise = std::sqrt(within / static_cast<double>(out.samples - kStretches));
  out.standard_error = std::sqrt(squares_about(means, mean_of(means)) / (kStretches * (kStretches - 1.0)));
  const auto [low, high] = std::ranges::minmax_element(means);
  out.wander = *high - *low;
  if (out.noise == 0.0 && out.wander == 0.0)
    refusals.push_back({"stuck", fmt::format("{}: every one of {} samples is the same", what, out.samples),
                        "a sensor has noise: check its cable and supply, and its range"});
  // Limit for noise: the range of ten means of white noise is 3.1 standard deviations on average, and 6 with
  // probability 1e-4. Doubled, because noise may be correlated over a few samples.
  const double by_noise = 12.0 * out.noise / std::sqrt(static_cast<double>(out.samples) / kStretches);
  if (out.wander > limits.max_wander + by_noise) refusals.push_back(of_wander(out, means, limits, what));
  return out;
}

}  // namespace sandhopper::calibrate
