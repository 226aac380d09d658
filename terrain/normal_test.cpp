#include "terrain/normal_test.hpp"

#include <algorithm>
#include <cmath>

namespace sandhopper {

// Gauss-Jordan elimination without pivoting, because S is positive definite.
void NormalTest::invert() const {
  inverse_ = covariance_;
  double* const m = inverse_.data();
  for (std::size_t k = 0; k < n_; ++k) {
    double* const row_k = m + k * n_;
    const double pivot = row_k[k];
    row_k[k] = 1.0;
    for (std::size_t j = 0; j < n_; ++j) row_k[j] /= pivot;
    for (std::size_t i = 0; i < n_; ++i) {
      if (i == k) continue;
      double* const row_i = m + i * n_;
      const double factor = row_i[k];
      row_i[k] = 0.0;
      for (std::size_t j = 0; j < n_; ++j) row_i[j] -= factor * row_k[j];
    }
  }
  weighted_.assign(n_, 0.0);
  distance_ = 0.0;
  for (std::size_t i = 0; i < n_; ++i) {
    for (std::size_t j = 0; j < n_; ++j) weighted_[i] += m[i * n_ + j] * value_[j];
    distance_ += value_[i] * weighted_[i];
  }
}

NormalTest::Result NormalTest::test(std::span<const double> shape) const {
  if (inverse_.empty()) invert();
  std::size_t first = 0, last = n_;  // a template is zero at most depths
  while (first < last && shape[first] == 0.0) ++first;
  while (last > first && shape[last - 1] == 0.0) --last;
  double along = 0.0, length = 0.0;
  for (std::size_t i = first; i < last; ++i) {
    along += shape[i] * weighted_[i];
    double row = 0.0;
    for (std::size_t j = first; j < last; ++j) row += inverse_[i * n_ + j] * shape[j];
    length += shape[i] * row;
  }
  if (!(length > 0.0)) return {};
  const double gain = along * along / length;
  const double freedom = std::max(1.0, static_cast<double>(n_) - terms_ - 1);
  const double scale = std::max(1.0, (distance_ - gain) / freedom);
  return {.size = along / length,
          .size_sd = std::sqrt(scale / length),
          .statistic = freedom * std::log1p(gain / (freedom * scale))};
}

}  // namespace sandhopper
