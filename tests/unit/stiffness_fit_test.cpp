#include "terrain/stiffness_fit.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>
#include <vector>

namespace sandhopper {
namespace {

using Samples = std::vector<FitSample>;

Samples noisy_line(std::mt19937_64& rng, int n, double correlation, double intercept, double slope) {
  std::normal_distribution<double> normal;
  Samples out;
  double noise = normal(rng);
  for (int i = 0; i < n; ++i) {
    noise = correlation * noise + std::sqrt(1.0 - correlation * correlation) * normal(rng);
    const double z = 0.04 * i / n;
    out.push_back({z, intercept + slope * z + noise, 1.0 + 0.5 * std::sin(0.1 * i)});
  }
  return out;
}

RegressionSums sums_of(const Samples& samples) {
  RecursiveRegression r;
  for (const auto& s : samples) r.add(s);
  return r.sums();
}

// The same estimator with full matrices.
struct Direct {
  Eigen::Vector2d theta;
  double slope_variance;
};
Direct direct_fit(const Samples& samples) {
  const auto n = static_cast<Eigen::Index>(samples.size());
  Eigen::MatrixXd x(n, 2);
  Eigen::VectorXd f(n), w(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto& s = samples[static_cast<std::size_t>(i)];
    x.row(i) << 1.0, s.depth_m;
    f(i) = s.force_N;
    w(i) = s.weight;
  }
  const Eigen::Matrix2d bread = (x.transpose() * w.asDiagonal() * x).inverse();
  const Eigen::Vector2d theta = bread * (x.transpose() * (w.array() * f.array()).matrix());
  const Eigen::VectorXd e = f - x * theta;
  Eigen::Matrix2d meat = Eigen::Matrix2d::Zero();
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j) {
      const double kernel = -static_cast<double>(std::abs(i - j)) / static_cast<double>(n);
      meat += kernel * w(i) * e(i) * w(j) * e(j) * x.row(i).transpose() * x.row(j);
    }
  const Eigen::Matrix2d cov = bread * meat * bread;
  return {theta, cov(1, 1) * static_cast<double>(n) / static_cast<double>(n - 2)};
}

TEST(StiffnessFit, RecursionEqualsTheMatrixFormula) {
  std::mt19937_64 rng(7);
  const auto samples = noisy_line(rng, 150, 0.9, 3.0, 1500.0);
  StiffnessConfig config;
  const auto fit = solve_stiffness(sums_of(samples), config);
  const auto direct = direct_fit(samples);
  EXPECT_NEAR(fit.value_N_per_m / direct.theta(1), 1.0, 1e-11);
  EXPECT_NEAR(fit.intercept_N, direct.theta(0), 1e-9);
  EXPECT_NEAR(fit.standard_error_N_per_m / std::sqrt(direct.slope_variance), 1.0, 1e-7);
}

TEST(StiffnessFit, IntervalsHoldTheTruthAsOftenAsTheySayWithCorrelatedResiduals) {
  StiffnessConfig config;
  for (const bool free_intercept : {true, false}) {
    config.free_intercept = free_intercept;
    for (const double correlation : {0.0, 0.6, 0.9}) {
      std::mt19937_64 rng(11);
      int held = 0;
      const int runs = 2000;
      for (int i = 0; i < runs; ++i) {
        const auto fit = solve_stiffness(sums_of(noisy_line(rng, 150, correlation, 0.0, 1500.0)), config);
        held += fit.ci95_low_N_per_m <= 1500.0 && 1500.0 <= fit.ci95_high_N_per_m;
      }
      const double share = static_cast<double>(held) / runs;
      printf("AR(1) %.1f, %s: 95 %% interval holds the truth in %.1f %% of %d lines\n", correlation,
             free_intercept ? "free intercept" : "through origin", 100 * share, runs);
      EXPECT_GE(share, 0.935) << correlation;
      EXPECT_LE(share, 0.99) << correlation;
    }
  }
}

TEST(StiffnessFit, ThroughOriginForcesTheInterceptToZero) {
  std::mt19937_64 rng(5);
  StiffnessConfig config;
  config.free_intercept = false;
  const auto fit = solve_stiffness(sums_of(noisy_line(rng, 150, 0.5, 0.0, 1500.0)), config);
  EXPECT_EQ(fit.intercept_N, 0.0);
  EXPECT_NEAR(fit.value_N_per_m, 1500.0, 30.0);
  EXPECT_EQ(fit.validity, Validity::valid);
}

TEST(StiffnessFit, SaysWhyItCannotTell) {
  std::mt19937_64 rng(5);
  StiffnessConfig config;
  EXPECT_EQ(solve_stiffness({}, config).validity, Validity::no_new_penetration);
  EXPECT_EQ(solve_stiffness(sums_of(noisy_line(rng, 10, 0, 0, 1500)), config).validity,
            Validity::too_few_samples);
  auto shallow = noisy_line(rng, 100, 0, 0, 1500);
  for (auto& s : shallow) s.depth_m *= 0.1;
  EXPECT_EQ(solve_stiffness(sums_of(shallow), config).validity, Validity::too_shallow);
  auto deep = noisy_line(rng, 100, 0, 0, 1500);
  for (auto& s : deep) s.depth_m *= 2.0;
  EXPECT_EQ(solve_stiffness(sums_of(deep), config).validity, Validity::deeper_than_foot);
  EXPECT_EQ(solve_stiffness(sums_of(noisy_line(rng, 100, 0, 90, -1500)), config).validity,
            Validity::not_positive);
  auto scattered = noisy_line(rng, 100, 0, 0, 1500);
  for (auto& sample : scattered) sample.force_N += 4e5 * std::pow(sample.depth_m - 0.02, 2);
  EXPECT_EQ(solve_stiffness(sums_of(scattered), config).validity, Validity::interval_includes_zero);
  auto flat = noisy_line(rng, 100, 0, 0, 1500);
  flat[50].force_N = std::nan("");
  EXPECT_EQ(solve_stiffness(sums_of(flat), config).validity, Validity::interval_unbounded);
}

TEST(AccelerationWeight, IsHalfWayAtTheThresholdAndSpansTheSigmas) {
  const WeightConfig c;
  const double half = (c.sigma_good_N + c.sigma_bad_N) / 2;
  EXPECT_DOUBLE_EQ(acceleration_weight(c, c.threshold_mps2), 1.0 / (half * half));
  const double ratio = acceleration_weight(c, 0.0) / acceleration_weight(c, 100.0);
  EXPECT_NEAR(ratio, std::pow(c.sigma_bad_N / c.sigma_good_N, 2), 5.0);
  double last = 1e9;
  for (double a = 0.0; a < 30.0; a += 0.5) {
    const double w = acceleration_weight(c, a);
    EXPECT_LT(w, last);
    last = w;
  }
}

}  // namespace
}  // namespace sandhopper
