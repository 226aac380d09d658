#include "terrain/next_stride.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace sandhopper {
namespace {

std::vector<StrideSetup> grid() {
  std::vector<StrideSetup> setups;
  for (const double height : {0.0025, 0.0125, 0.0303, 0.0618, 0.0890})
    for (const double stiffness : {250.0, 375.0, 500.0}) setups.push_back({height, stiffness});
  return setups;
}

ProfileSolver after(const StrideSetup& setup) {
  ProfileSolver solver{StiffnessConfig{}};
  solver.add(predicted_stride(solver, {}, setup), 1);
  return solver;
}

TEST(NextStride, PredictedStridesSinkDeeperFromHigher) {
  const ProfileSolver solver{StiffnessConfig{}};
  const auto low = predicted_stride(solver, {}, {0.005, 375.0}), high = predicted_stride(solver, {}, {0.090, 375.0});
  EXPECT_GT(low.depth_max_m, 0.010);
  EXPECT_GT(high.depth_max_m, low.depth_max_m);
  EXPECT_LT(high.depth_max_m, 0.070);
}

TEST(NextStride, IsExpectedToNarrowTheBandMoreThanTheOthers) {
  const auto solver = after({0.0125, 250.0});
  const auto setups = grid();
  const auto best = next_stride(solver, {}, setups);
  EXPECT_LT(best.widest_expected, best.widest_now);
  for (const auto& setup : setups) {
    const auto one = next_stride(solver, {}, {&setup, 1});
    if (one.reach_m <= 0.0525) EXPECT_LE(best.widest_expected, one.widest_expected + 1e-12);
  }
}

TEST(NextStride, FreshGroundAddsToWhatIsKnown) {
  auto solver = after({0.0125, 250.0});
  const double before = widest_band(solver, {});
  solver.add(predicted_stride(solver, {}, {0.0618, 250.0}), 0);
  EXPECT_LT(widest_band(solver, {}), before);
  EXPECT_EQ(solver.profile().stride, 2u);
}

}  // namespace
}  // namespace sandhopper
