#include <gtest/gtest.h>

#include <cmath>

#include "firmware/stride_recorder.hpp"
#include "terrain/strength_profile.hpp"

namespace sandhopper {
namespace {

constexpr double kRadius_m = 0.040;
constexpr double kReducedMass_kg = 0.68;

// A slow foot on the believed bed.
ProfileSums slow_push(double from_m, double to_m, double duration_s = 1e-3, double too_deep_m = 0.0) {
  ProfileRegression regression({}, kRadius_m, kReducedMass_kg);
  constexpr double kSpeed_mps = 0.1;
  double t = 1e-3;
  for (double z = from_m; z < to_m; z += 1e-3 * kSpeed_mps, t += 1e-3) {
    const double force = believed_force_N({}, z);
    regression.add({z + too_deep_m, kSpeed_mps, 0.0, force, 0.0, t, duration_s}, force);
  }
  return regression.sums();
}

// A sample that weighs next to nothing.
ProfileSums touch_at(double depth_m) { return slow_push(depth_m, depth_m + 1e-5, 1e-9); }

TEST(ProfileMemory, BandStaysWhereAStrideAddsNothing) {
  ProfileSolver solver{StiffnessConfig{}};
  solver.add(slow_push(1e-4, 0.030), 1);
  const ProfileSolver before = solver;
  for (const std::uint32_t stride : {2U, 3U}) {
    solver.add(touch_at(0.0305), stride);
    for (double z = 0.005; z < 0.028; z += 0.0025) {
      EXPECT_NEAR(solver.force_N(z).sd / before.force_N(z).sd, 1.0, 0.02) << z;
      EXPECT_NEAR(solver.force_N(z).value, before.force_N(z).value, 0.05 * before.force_N(z).sd) << z;
    }
  }
}

// On a bed that is known the first stride shows its depth error, and the second begins with it.
TEST(ProfileMemory, LaterStrideBeginsWithTheDepthErrorOfItsCrater) {
  StiffnessConfig config;
  config.joint.intercept_depth_sd_m = 1e-5;
  config.profile = ProfileConfig{.stiffness_spread_relative = 0.01};
  for (const double too_deep_m : {-0.001, 0.001}) {
    ProfileSolver solver(config);
    const auto sums = slow_push(0.002, 0.040, 1e-3, too_deep_m);
    solver.add(sums, 1);
    const auto first = solver.profile();
    const double at_crater_m = first.surface_m + first.depth_drift_mps * sums.last_s;
    EXPECT_NEAR(at_crater_m, -too_deep_m, 5e-4);
    solver.add(touch_at(sums.depth_max_m + 1e-4), 2);
    EXPECT_NEAR(solver.profile().surface_m, at_crater_m, 1e-4);
  }
}

TEST(ProfileMemory, BlowBeforeNewGroundSettlesToo) {
  ProfileRegression regression({}, kRadius_m, kReducedMass_kg);
  const JointSample blow{0.010, 0.5, -147.0, 90.0, 0.0, 1e-3, 1e-3};
  EXPECT_FALSE(regression.watch(blow));
  regression.add({0.0102, 0.5, -70.0, 60.0, 0.0, 3.9e-3, 1e-3}, 20.0);
  EXPECT_EQ(regression.sums().samples, 0);
  regression.add({0.0104, 0.5, -70.0, 60.0, 0.0, 4.1e-3, 1e-3}, 20.0);
  EXPECT_EQ(regression.sums().samples, 1);
}

// A foot that goes down and then rests while the estimated depth drifts.
TEST(StrideRecorder, DriftOfAFootAtRestIsNoNewDepth) {
  StrideRecorder recorder({}, {kRadius_m, kReducedMass_kg});
  recorder.on_release(0);
  std::int64_t now_ns = 0;
  const auto update = [&](double depth_m, double speed_mps, State state) {
    now_ns += 1'000'000;
    Estimate e;
    e.foot_z_m = -depth_m;
    e.force_depth_m = depth_m;
    e.force_velocity_mps = speed_mps;
    e.force_time_ns = now_ns;
    e.direct_force_N = 5.0 + 1500.0 * depth_m;
    recorder.update(e, state);
  };
  update(0.0, 0.2, State::flight);
  recorder.on_touchdown(now_ns);
  double depth_m = 0.0;
  for (; depth_m < 0.020; depth_m += 2e-4) update(depth_m, 0.2, State::compression);
  for (; depth_m < 0.024; depth_m += 5e-6) update(depth_m, 0.005, State::compression);
  EXPECT_NEAR(recorder.new_ground_m(), 0.020, 3e-4);
  recorder.on_liftoff(now_ns);
  update(0.0, 0.5, State::flight);
  recorder.on_touchdown(now_ns);
  recorder.on_liftoff(now_ns);
  EXPECT_NEAR(recorder.sums().summary.crater_depth_m, 0.020, 3e-4);
}

}  // namespace
}  // namespace sandhopper
