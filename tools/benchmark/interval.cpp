#include "tools/benchmark/interval.hpp"

#include <algorithm>
#include <cmath>

namespace sandhopper::benchmark {
namespace {

// P(X >= count) for a binomial X with `of` draws and probability p.
double upper_tail(std::size_t count, std::size_t of, double p) {
  double sum = 0.0;
  const double n = static_cast<double>(of);
  for (std::size_t i = count; i <= of; ++i) {
    const double k = static_cast<double>(i);
    sum += std::exp(std::lgamma(n + 1) - std::lgamma(k + 1) - std::lgamma(n - k + 1) + k * std::log(p) +
                    (n - k) * std::log1p(-p));
  }
  return sum;
}

// The p at which the increasing function reaches the level.
template <class Function>
double solve(const Function& rising, double level) {
  double low = 1e-12, high = 1.0 - 1e-12;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (rising(middle) < level ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

Interval wilson95(std::size_t count, std::size_t of) {
  if (of == 0) return {0.0, 1.0};
  constexpr double z = 1.959963985;
  const double n = static_cast<double>(of), p = static_cast<double>(count) / n;
  const double centre = (p + z * z / (2 * n)) / (1 + z * z / n);
  const double half = z * std::sqrt(p * (1 - p) / n + z * z / (4 * n * n)) / (1 + z * z / n);
  return {std::max(0.0, centre - half), std::min(1.0, centre + half)};
}

Interval clopper_pearson95(std::size_t count, std::size_t of) {
  if (of == 0) return {0.0, 1.0};
  const double low = count == 0 ? 0.0 : solve([&](double p) { return upper_tail(count, of, p); }, 0.025);
  const double high =
      count == of ? 1.0 : solve([&](double p) { return upper_tail(count + 1, of, p); }, 0.975);
  return {low, high};
}

}  // namespace sandhopper::benchmark
