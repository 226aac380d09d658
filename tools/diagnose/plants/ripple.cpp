#include "tools/diagnose/plants/ripple.hpp"

#include <algorithm>
#include <cmath>

namespace sandhopper::diagnose {
namespace {

constexpr std::size_t kOrders = 3;  // most orders that are returned

}  // namespace

std::vector<double> strongest_orders(const std::vector<double>& angles, const std::vector<double>& torques,
                                     int first, int last) {
  std::vector<double> power;
  for (int n = first; n <= last; ++n) {
    double re = 0.0, im = 0.0;
    for (std::size_t i = 0; i < torques.size(); ++i) {
      re += torques[i] * std::cos(n * angles[i]);
      im += torques[i] * std::sin(n * angles[i]);
    }
    power.push_back(re * re + im * im);
  }
  std::vector<std::size_t> peaks;
  for (std::size_t k = 1; k + 1 < power.size(); ++k)
    if (power[k] >= power[k - 1] && power[k] > power[k + 1]) peaks.push_back(k);
  std::sort(peaks.begin(), peaks.end(), [&](std::size_t a, std::size_t b) { return power[a] > power[b]; });
  std::vector<double> orders;
  for (std::size_t k = 0; k < std::min(peaks.size(), kOrders); ++k)
    orders.push_back(first + static_cast<double>(peaks[k]));
  return orders;
}

}  // namespace sandhopper::diagnose
