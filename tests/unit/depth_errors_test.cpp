#include "tools/experiment/depth_errors.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace sandhopper {
namespace {

constexpr double kDecay_per_s = 5.0;

TEST(DepthErrors, SpreadsOfSimulatedStridesAreFound) {
  std::mt19937 engine(1);
  std::normal_distribution<double> normal;
  std::vector<StrideDepthErrors> strides(1600);
  for (auto& stride : strides) {
    const double surface_m = 4e-4 * normal(engine);
    const double lag_s = 8e-4 * normal(engine), speed_mps = 0.7 + 0.2 * normal(engine);
    // A stationary pair whose first part has the correlation exp(-a t) cos(a t): it turns while it decays.
    constexpr double kStep_s = 0.02, kFilter_m = 7e-4;
    const double turn = kDecay_per_s * kStep_s, keep = std::exp(-turn), fresh = std::sqrt(1.0 - keep * keep);
    double x_m = kFilter_m * normal(engine), y_m = kFilter_m * normal(engine);
    const double start_m = x_m;
    for (int i = 1; i <= 15; ++i) {
      const double t = kStep_s * i, change_mps = -speed_mps * (1.0 - std::exp(-t / 0.05));
      const double turned_m = keep * (std::cos(turn) * x_m - std::sin(turn) * y_m);
      y_m = keep * (std::sin(turn) * x_m + std::cos(turn) * y_m) + fresh * kFilter_m * normal(engine);
      x_m = turned_m + fresh * kFilter_m * normal(engine);
      stride.push_back(
          {t, change_mps, surface_m + x_m - start_m + lag_s * change_mps + 2.5e-4 * normal(engine)});
    }
  }
  const auto spread = depth_error_spread(strides, kDecay_per_s);
  EXPECT_NEAR(spread.surface_sd_m, 4e-4, 0.6e-4);
  EXPECT_NEAR(spread.filter_sd_m, 7e-4, 0.7e-4);
  EXPECT_NEAR(spread.lag_sd_s, 8e-4, 0.8e-4);
  EXPECT_NEAR(spread.rest_sd_m, 2.5e-4, 0.2e-4);
}

TEST(DepthErrors, WithoutStridesThereIsNoSpread) {
  EXPECT_TRUE(std::isnan(depth_error_spread({}).surface_sd_m));
}

}  // namespace
}  // namespace sandhopper
