#include "tools/experiment/depth_errors.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

namespace sandhopper {
namespace {

constexpr std::size_t kEffects = 4;  // d, x, l and the rest
constexpr int kRounds = 60;          // the spreads change by less than 2 % after these

// Errors of a stride, and their covariance for a unit variance of each effect.
struct StrideCovariances {
  Eigen::VectorXd error;
  std::array<Eigen::MatrixXd, kEffects> unit;
};

StrideCovariances covariances_of(const StrideDepthErrors& stride, double decay_per_s) {
  const auto correlation = [&](double time_s) {
    const double phase = decay_per_s * std::abs(time_s);
    return std::exp(-phase) * std::cos(phase);
  };
  const auto n = static_cast<Eigen::Index>(stride.size());
  StrideCovariances out{.error = Eigen::VectorXd(n), .unit = {}};
  out.unit.fill(Eigen::MatrixXd::Zero(n, n));
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto& a = stride[static_cast<std::size_t>(i)];
    out.error(i) = a.error_m;
    out.unit[3](i, i) = 1.0;
    for (Eigen::Index j = 0; j < n; ++j) {
      const auto& b = stride[static_cast<std::size_t>(j)];
      out.unit[0](i, j) = 1.0;
      out.unit[1](i, j) = 1.0 + correlation(a.since_contact_s - b.since_contact_s) -
                          correlation(a.since_contact_s) - correlation(b.since_contact_s);
      out.unit[2](i, j) = a.change_mps * b.change_mps;
    }
  }
  return out;
}

}  // namespace

DepthErrorSpread depth_error_spread(std::span<const StrideDepthErrors> strides, double decay_per_s) {
  std::vector<StrideCovariances> all;
  for (const auto& stride : strides)
    if (stride.size() >= 2) all.push_back(covariances_of(stride, decay_per_s));
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  if (all.empty()) return {kNan, kNan, kNan, kNan};
  std::array<double, kEffects> variance{1e-7, 1e-6, 1e-7, 1e-8};
  for (int round = 0; round < kRounds; ++round) {
    std::array<double, kEffects> found{}, expected{};
    for (const auto& s : all) {
      Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(s.error.size(), s.error.size());
      for (std::size_t i = 0; i < kEffects; ++i) sum += variance[i] * s.unit[i];
      const Eigen::MatrixXd inverse = sum.llt().solve(Eigen::MatrixXd::Identity(sum.rows(), sum.cols()));
      const Eigen::VectorXd solved = inverse * s.error;
      for (std::size_t i = 0; i < kEffects; ++i) {
        found[i] += solved.dot(s.unit[i] * solved);
        expected[i] += inverse.cwiseProduct(s.unit[i]).sum();
      }
    }
    for (std::size_t i = 0; i < kEffects; ++i) variance[i] *= std::sqrt(found[i] / expected[i]);
  }
  return {std::sqrt(variance[0]), std::sqrt(variance[1]), std::sqrt(variance[2]), std::sqrt(variance[3])};
}

}  // namespace sandhopper
