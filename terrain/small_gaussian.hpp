#pragma once
#include <array>
#include <cmath>
#include <cstddef>

// Cholesky decomposition of a small positive definite matrix, in plain loops and without allocation. Eigen
// sums in an order that depends on the processor, and a replay of a log must give the same bits on every
// processor.
namespace sandhopper {

// M = U^T U. Every element is the same sum in the same order as row by row, but no addition waits for the one
// before. A pivot that is not positive because of rounding is replaced by a tiny one.
template <std::size_t N>
class Cholesky {
 public:
  // Uses the upper triangle.
  explicit Cholesky(const std::array<double, N * N>& matrix) noexcept : root_(matrix) {
    for (std::size_t k = 0; k < N; ++k) {
      double* const row = &root_[k * N];
      row[k] = std::sqrt(row[k] > kLeastPivot ? row[k] : kLeastPivot);
      for (std::size_t j = k + 1; j < N; ++j) row[j] /= row[k];
      for (std::size_t i = k + 1; i < N; ++i) {
        double* const below = &root_[i * N];
        const double factor = row[i];
        for (std::size_t j = i; j < N; ++j) below[j] -= factor * row[j];
      }
    }
  }

  // U^-T b. The product of two such vectors is a^T M^-1 b.
  std::array<double, N> scaled(std::array<double, N> b) const noexcept {
    for (std::size_t i = 0; i < N; ++i) {
      b[i] /= root_[i * N + i];
      for (std::size_t j = i + 1; j < N; ++j) b[j] -= root_[i * N + j] * b[i];
    }
    return b;
  }

  // M^-1 b.
  std::array<double, N> solve(const std::array<double, N>& right) const noexcept {
    auto b = scaled(right);
    for (std::size_t i = N; i-- > 0;) {
      for (std::size_t k = i + 1; k < N; ++k) b[i] -= root_[i * N + k] * b[k];
      b[i] /= root_[i * N + i];
    }
    return b;
  }

  // M^-1 = K^T K with K = U^-T.
  std::array<double, N * N> inverse() const noexcept {
    std::array<double, N * N> k{};  // row m of K
    for (std::size_t m = 0; m < N; ++m) k[m * N + m] = 1.0;
    for (std::size_t i = 0; i < N; ++i) {
      for (std::size_t j = 0; j <= i; ++j) k[i * N + j] /= root_[i * N + i];
      for (std::size_t m = i + 1; m < N; ++m) {
        const double factor = root_[i * N + m];
        for (std::size_t j = 0; j <= i; ++j) k[m * N + j] -= factor * k[i * N + j];
      }
    }
    std::array<double, N * N> result{};
    for (std::size_t m = 0; m < N; ++m)
      for (std::size_t i = 0; i <= m; ++i)
        for (std::size_t j = 0; j <= i; ++j) result[i * N + j] += k[m * N + i] * k[m * N + j];
    for (std::size_t i = 0; i < N; ++i)
      for (std::size_t j = 0; j < i; ++j) result[j * N + i] = result[i * N + j];
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
  std::array<double, N * N> root_;
};

}  // namespace sandhopper
