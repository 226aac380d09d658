#pragma once
#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace sandhopper {

// Standard deviation of the noise of a signal that changes evenly, from the median magnitude of its second
// differences x[i] - 2 x[i-1] + x[i-2]: those of white noise have the deviation sqrt(6) s, and the median
// magnitude of a normal distribution is 0.6745 of its deviation.
inline double noise_of_bends(std::span<const double> values) {
  std::vector<double> bends;
  for (std::size_t i = 2; i < values.size(); ++i)
    if (const double bend = std::abs(values[i] - 2.0 * values[i - 1] + values[i - 2]); !std::isnan(bend))
      bends.push_back(bend);
  if (bends.empty()) return 0.0;
  const auto middle = bends.begin() + static_cast<std::ptrdiff_t>(bends.size() / 2);
  std::nth_element(bends.begin(), middle, bends.end());
  return *middle / (0.6745 * std::sqrt(6.0));
}

// Smallest difference of two values that are not equal within the rounding of a double.
inline double digit_of(std::vector<double> values) {
  std::erase_if(values, [](double value) { return std::isnan(value); });
  if (values.empty()) return 0.0;
  std::ranges::sort(values);
  const double rounding = 1e-12 * std::max(std::abs(values.front()), std::abs(values.back()));
  double least = values.back() - values.front();
  for (std::size_t i = 1; i < values.size(); ++i)
    if (values[i] - values[i - 1] > rounding) least = std::min(least, values[i] - values[i - 1]);
  return std::max(least, rounding);
}

}  // namespace sandhopper
