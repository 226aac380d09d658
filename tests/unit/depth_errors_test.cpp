#include "tools/experiment/depth_errors.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace sandhopper {
namespace {

TEST(DepthErrors, SpreadsOfSimulatedStridesAreFound) {
  std::mt19937 engine(1);
  std::normal_distribution<double> normal;
  std::vector<StrideDepthErrors> strides(400);
  for (auto& stride : strides) {
    const double surface_m = 4e-4 * normal(engine), drift_mps = 5e-3 * normal(engine);
    const double lag_s = 8e-4 * normal(engine), speed_mps = 0.7 + 0.2 * normal(engine);
    for (int i = 1; i <= 15; ++i) {
      const double t = 0.02 * i, change_mps = -speed_mps * (1.0 - std::exp(-t / 0.05));
      stride.push_back(
          {t, change_mps, surface_m + drift_mps * t + lag_s * change_mps + 2.5e-4 * normal(engine)});
    }
  }
  const auto spread = depth_error_spread(strides);
  EXPECT_NEAR(spread.surface_sd_m, 4e-4, 0.6e-4);
  EXPECT_NEAR(spread.drift_sd_mps, 5e-3, 0.5e-3);
  EXPECT_NEAR(spread.lag_sd_s, 8e-4, 0.8e-4);
  EXPECT_NEAR(spread.rest_sd_m, 2.5e-4, 0.1e-4);
}

TEST(DepthErrors, WithoutStridesThereIsNoSpread) {
  EXPECT_TRUE(std::isnan(depth_error_spread({}).surface_sd_m));
}

}  // namespace
}  // namespace sandhopper
