#pragma once
#include <array>
#include <cmath>
#include <cstddef>

// Cholesky decomposition of a small positive definite matrix, in plain loops and without allocation. Eigen
// sums in an order that depends on the processor, and a replay of a log must give the same bits on every
// processor.
namespace sandhopper {

// M = L L^T, row by row. A pivot that is not positive because of rounding is replaced by a tiny one.
template <std::size_t N>
class Cholesky {
 public:
  explicit Cholesky(const std::array<double, N * N>& matrix) noexcept {
    for (std::size_t i = 0; i < N; ++i)
      for (std::size_t j = 0; j <= i; ++j) {
        double sum = matrix[i * N + j];
        for (std::size_t k = 0; k < j; ++k) sum -= root_[i * N + k] * root_[j * N + k];
        if (i != j)
          root_[i * N + j] = sum / root_[j * N + j];
        else
          root_[i * N + i] = std::sqrt(sum > kLeastPivot ? sum : kLeastPivot);
      }
  }

  // M^-1 b.
  std::array<double, N> solve(std::array<double, N> b) const noexcept {
    for (std::size_t i = 0; i < N; ++i) {
      for (std::size_t k = 0; k < i; ++k) b[i] -= root_[i * N + k] * b[k];
      b[i] /= root_[i * N + i];
    }
    for (std::size_t i = N; i-- > 0;) {
      for (std::size_t k = i + 1; k < N; ++k) b[i] -= root_[k * N + i] * b[k];
      b[i] /= root_[i * N + i];
    }
    return b;
  }

  // M^-1 = K^T K with K = L^-1.
  std::array<double, N * N> inverse() const noexcept {
    std::array<double, N * N> k{};
    for (std::size_t j = 0; j < N; ++j) {
      k[j * N + j] = 1.0 / root_[j * N + j];
      for (std::size_t i = j + 1; i < N; ++i) {
        double sum = 0.0;
        for (std::size_t m = j; m < i; ++m) sum -= root_[i * N + m] * k[j * N + m];
        k[j * N + i] = sum / root_[i * N + i];  // column j of K, stored as a row
      }
    }
    std::array<double, N * N> result{};
    for (std::size_t i = 0; i < N; ++i)
      for (std::size_t j = 0; j <= i; ++j) {
        double sum = 0.0;
        for (std::size_t m = i; m < N; ++m) sum += k[i * N + m] * k[j * N + m];
        result[i * N + j] = result[j * N + i] = sum;
      }
    return result;
  }

  // Half the logarithm of the determinant.
  double half_log_determinant() const noexcept {
    double sum = 0.0;
    for (std::size_t i = 0; i < N; ++i) sum += std::log(root_[i * N + i]);
    return sum;
  }

 private:
  static constexpr double kLeastPivot = 1e-300;
  std::array<double, N * N> root_{};
};

}  // namespace sandhopper
