#include "terrain/trial_statistics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace sandhopper {

double student_t95(std::size_t degrees_of_freedom) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr std::array kTable{kInfinity, 12.7062, 4.3027, 3.1824, 2.7764,
                              2.5706,    2.4469,  2.3646, 2.3060, 2.2622};
  if (degrees_of_freedom < kTable.size()) return kTable[degrees_of_freedom];
  // Expansion about the normal quantile (Abramowitz & Stegun 26.7.5), accurate to five digits from 10 degrees
  // of freedom on.
  constexpr double z = 1.959964;
  const double n = static_cast<double>(degrees_of_freedom);
  const double g1 = (z * z * z + z) / 4.0;
  const double g2 = (5.0 * std::pow(z, 5) + 16.0 * z * z * z + 3.0 * z) / 96.0;
  const double g3 = (3.0 * std::pow(z, 7) + 19.0 * std::pow(z, 5) + 17.0 * z * z * z - 15.0 * z) / 384.0;
  const double g4 = (79.0 * std::pow(z, 9) + 776.0 * std::pow(z, 7) + 1482.0 * std::pow(z, 5) -
                     1920.0 * z * z * z - 945.0 * z) /
                    92160.0;
  return z + g1 / n + g2 / (n * n) + g3 / (n * n * n) + g4 / std::pow(n, 4);
}

TrialMean mean_over_trials(std::span<const double> per_trial) {
  TrialMean out;
  double sum = 0.0;
  for (const double value : per_trial)
    if (!std::isnan(value)) {
      sum += value;
      ++out.trials;
    }
  const double n = static_cast<double>(out.trials);
  out.value = out.trials > 0 ? sum / n : std::numeric_limits<double>::quiet_NaN();
  double squares = 0.0;
  for (const double value : per_trial)
    if (!std::isnan(value)) squares += (value - out.value) * (value - out.value);
  out.standard_deviation = out.trials > 1 ? std::sqrt(squares / (n - 1.0)) : 0.0;
  const double half = out.trials > 1 ? student_t95(out.trials - 1) * out.standard_deviation / std::sqrt(n)
                                     : std::numeric_limits<double>::infinity();
  out.ci95_low = out.value - half;
  out.ci95_high = out.value + half;
  return out;
}

PercentileInterval percentile_interval(std::span<const double> replicates) {
  std::vector<double> sorted(replicates.begin(), replicates.end());
  std::erase_if(sorted, [](double value) { return std::isnan(value); });
  if (sorted.empty())
    return {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  std::sort(sorted.begin(), sorted.end());
  const auto at = [&](double share) {
    const double place = share * static_cast<double>(sorted.size() - 1);
    const auto low = static_cast<std::size_t>(place);
    const auto high = std::min(low + 1, sorted.size() - 1);
    return sorted[low] + (place - static_cast<double>(low)) * (sorted[high] - sorted[low]);
  };
  return {at(0.025), at(0.975)};
}

}  // namespace sandhopper
