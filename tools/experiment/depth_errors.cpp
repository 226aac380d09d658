#include "tools/experiment/depth_errors.hpp"

#include <cmath>

#include "terrain/small_gaussian.hpp"

namespace sandhopper {
namespace {

constexpr std::size_t kEffects = 3;  // d, r, l
constexpr int kRounds = 150;         // the spreads change by less than 1 % after 100

// Products of a stride's errors e and their regressors x.
struct DepthProducts {
  std::array<double, kEffects * kEffects> xx{};
  std::array<double, kEffects> xe{};
  double ee = 0.0, count = 0.0;
};

DepthProducts products_of(const StrideDepthErrors& stride) {
  DepthProducts p;
  for (const DepthError& s : stride) {
    const std::array<double, kEffects> x{1.0, s.since_contact_s, s.change_mps};
    for (std::size_t i = 0; i < kEffects; ++i) {
      p.xe[i] += x[i] * s.error_m;
      for (std::size_t j = 0; j < kEffects; ++j) p.xx[i * kEffects + j] += x[i] * x[j];
    }
    p.ee += s.error_m * s.error_m;
    p.count += 1.0;
  }
  return p;
}

// Adds the expected squares of the effects and of the rest in one stride.
void expect_squares(const DepthProducts& p, const std::array<double, kEffects>& variance, double rest,
                    std::array<double, kEffects>& squares, double& rest_squares) {
  auto precision = p.xx;
  auto moment = p.xe;
  for (double& value : precision) value /= rest;
  for (double& value : moment) value /= rest;
  for (std::size_t i = 0; i < kEffects; ++i) precision[i * kEffects + i] += 1.0 / variance[i];
  const Cholesky<kEffects> root(precision);
  const auto mean = root.solve(moment);
  const auto covariance = root.inverse();
  rest_squares += p.ee;
  for (std::size_t i = 0; i < kEffects; ++i) {
    squares[i] += mean[i] * mean[i] + covariance[i * kEffects + i];
    rest_squares -= 2.0 * mean[i] * p.xe[i];
    for (std::size_t j = 0; j < kEffects; ++j)
      rest_squares += p.xx[i * kEffects + j] * (mean[i] * mean[j] + covariance[i * kEffects + j]);
  }
}

}  // namespace

DepthErrorSpread depth_error_spread(std::span<const StrideDepthErrors> strides) {
  std::vector<DepthProducts> products;
  double count = 0.0;
  for (const auto& stride : strides) {
    if (stride.size() < 2) continue;
    products.push_back(products_of(stride));
    count += products.back().count;
  }
  std::array<double, kEffects> variance{1e-6, 1e-4, 1e-6};
  double rest = 1e-7;
  for (int round = 0; round < kRounds; ++round) {
    std::array<double, kEffects> squares{};
    double rest_squares = 0.0;
    for (const auto& p : products) expect_squares(p, variance, rest, squares, rest_squares);
    for (std::size_t i = 0; i < kEffects; ++i)
      variance[i] = squares[i] / static_cast<double>(products.size());
    rest = rest_squares / count;
  }
  return {std::sqrt(variance[0]), std::sqrt(variance[1]), std::sqrt(variance[2]), std::sqrt(rest)};
}

}  // namespace sandhopper
