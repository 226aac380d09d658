#include "terrain/next_stride.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "firmware/hop_model.hpp"
#include "tests/unit/profile_pushes.hpp"
#include "tools/experiment/stride_sessions.hpp"

namespace sandhopper {
namespace {

// The belief that all places of a ground are equally strong.
StiffnessConfig places_alike() {
  StiffnessConfig config;
  config.profile = ProfileConfig{.place_strength_sd_relative = 1e-6};
  return config;
}

ProfileSolver after(const StrideSetup& setup, const StiffnessConfig& config = {}) {
  ProfileSolver solver{config};
  solver.add(predicted_stride(solver, hop_model_of({}), setup), 1);
  return solver;
}

TEST(NextStride, PredictedStridesSinkDeeperFromHigherAndWithASofterLeg) {
  const auto robot = hop_model_of({});
  const ProfileSolver solver{StiffnessConfig{}};
  const auto reach = [&](double height_m, double stiffness) {
    return predicted_stride(solver, robot, {height_m, stiffness}).depth_max_m;
  };
  EXPECT_GT(reach(0.090, 375.0), reach(0.020, 375.0));
  EXPECT_GT(reach(0.060, 250.0), reach(0.060, 500.0));
  EXPECT_GT(reach(0.005, 500.0), 0.020);
  EXPECT_LT(reach(0.090, 250.0), kProfileDepth_m + 0.001);
}

TEST(NextStride, GoesWhereTheBandIsWidest) {
  const auto robot = hop_model_of({});
  const auto solver = after({0.0303, 500.0}, places_alike());
  ASSERT_LT(solver.profile().depth_max_m, 0.040);
  const auto setups = stride_setups();
  const auto next = next_stride(solver, robot, setups);
  EXPECT_GT(next.range.to_m, solver.profile().depth_max_m);
  EXPECT_GT(next.reach_m, solver.profile().depth_max_m + 0.005);
  EXPECT_LT(next.widest_expected_N, 0.6 * next.widest_now_N);
  // A set-up that stays above the present depth must not narrow the widest part of the band.
  const StrideSetup shallow{0.0025, 500.0};
  ProfileSolver shallower = solver;
  shallower.add(predicted_stride(solver, robot, shallow), 0);
  EXPECT_GT(widest_band_N(shallower, next.range), 0.7 * next.widest_now_N);
}

// Depths that only the second place reached are less known if its strength may differ from that of the first.
TEST(NextStride, ExpectsLessFromANewPlaceIfPlacesDiffer) {
  const auto expected = [](const StiffnessConfig& config) {
    const auto next = next_stride(after({0.0303, 500.0}, config), hop_model_of({}), stride_setups());
    return next.widest_expected_N / next.widest_now_N;
  };
  const double alike = expected(places_alike()), different = expected({});
  EXPECT_GT(different, 1.1 * alike);
  EXPECT_LT(different, 0.95);
}

ProfileSolver on_soft_ground() {
  ProfileSolver solver{StiffnessConfig{}};
  const auto curve_N = [](double z) { return 0.6 * line_N(z); };
  solver.add(sums_of(curve_N, {.speed_mps = 1.2, .to_m = 0.060}), 1);
  return solver;
}

// On soft ground the leg's push goes into the ground. The robot comes to rest and the stride is not measured.
TEST(NextStride, ExpectsNothingFromASetUpThatDoesNotLiftOff) {
  const auto robot = hop_model_of({});
  const auto solver = on_soft_ground();
  const StrideSetup weak{0.0125, 500.0}, strong{0.0890, 375.0};
  EXPECT_EQ(predicted_stride(solver, robot, weak).samples, 0u);
  EXPECT_GT(predicted_stride(solver, robot, strong).samples, 0u);
  const std::array both{weak, strong};
  const auto next = next_stride(solver, robot, both);
  EXPECT_EQ(next.setup.drop_height_m, strong.drop_height_m);
  const auto only_weak = next_stride(solver, robot, std::span(both).first(1));
  EXPECT_EQ(only_weak.reach_m, 0.0);
  EXPECT_DOUBLE_EQ(only_weak.widest_expected_N, only_weak.widest_now_N);
}

// A mean over places to which a place without samples belonged would be less known.
TEST(NextStride, AStrideWithoutSamplesIsNoPlace) {
  auto solver = on_soft_ground();
  solver.add(sums_of(line_N, {.to_m = 0.050}), ProfileSolver::kFreshGround);
  const auto before = solver.profile();
  solver.add({}, ProfileSolver::kFreshGround);
  EXPECT_EQ(solver.profile().force_N, before.force_N);
  EXPECT_EQ(solver.profile().force_sd_N, before.force_sd_N);
  EXPECT_EQ(solver.profile().stride, before.stride + 1);
}

// A step of 20 N over 1.25 mm is no curve on cells of 2.5 mm. A predicted stride fits it, a real one does
// not.
TEST(NextStride, DoesNotHopForAStepWithinACell) {
  ProfileRegression regression({}, 0.040, 0.68);
  double t = 0.0;
  for (double z = 1e-4; z < 0.045; z += 2e-4) {
    const double force = believed_force_N({}, z) + (z > 0.0200 && z < 0.02125 ? 20.0 : 0.0);
    regression.add({z, 0.2, 0.0, force, -0.1, t += 1e-3, 1e-3}, force);
  }
  ProfileSolver solver{StiffnessConfig{}};
  solver.add(regression.sums(), 1);
  const DepthRange range{0.005, 0.040};
  const double whole_N = widest_band_N(solver, range);
  EXPECT_GT(whole_N, 1.5 * widest_band_N(solver, range, ProfileSolver::Band::narrowable));
  const auto next = next_stride(solver, hop_model_of({}), stride_setups(), range);
  EXPECT_LT(next.widest_now_N, 0.7 * whole_N);
}

// Fresh ground has another surface height each time, so the error of the surface averages out. On the same
// ground it does not.
TEST(NextStride, FreshGroundAddsToWhatIsKnown) {
  auto config = places_alike();
  config.profile->steady_drag_sd = 1e-6;
  ProfileSolver solver(config);
  solver.add(predicted_stride(solver, hop_model_of({}), {0.0303, 375.0}), 1);
  const double before = solver.force_N(0.005).sd;
  const auto again = predicted_stride(solver, {}, {0.0303, 375.0});
  for (int i = 0; i < 3; ++i) solver.add(again, 0);
  EXPECT_LT(solver.force_N(0.005).sd, 0.75 * before);
  EXPECT_GT(solver.force_N(0.005).sd, 0.4 * before);
  EXPECT_EQ(solver.profile().stride, 4u);
}

TEST(StrideSessions, PlannedStridesHalveTheBandSooner) {
  const auto scores = score_sessions({.beds = {"gradually_denser"}, .sessions = 4, .threads = 1});
  ASSERT_EQ(scores.size(), 1u);
  EXPECT_EQ(scores[0].sessions, 4.0);
  EXPECT_LT(scores[0].mean(NextBy::plan), scores[0].mean(NextBy::chance));
  EXPECT_GE(scores[0].mean_narrowable(NextBy::plan), 1.0);
  EXPECT_LT(scores[0].mean_narrowable(NextBy::plan), 0.5 * scores[0].mean_narrowable(NextBy::chance));
}

// Neither bound needs more strides than the plan, which has the same choice and does not know the outcome.
TEST(StrideSessions, BoundsThatKnowTheOutcomeAreBelowThePlan) {
  const auto scores =
      score_sessions({.beds = {"gradually_denser"}, .sessions = 3, .threads = 1, .bounds = true});
  const double least = std::min(scores[0].mean(NextBy::outcome), scores[0].mean(NextBy::fixed));
  EXPECT_GE(least, 1.0);
  EXPECT_LE(least, scores[0].mean(NextBy::plan));
}

// Two sessions of 6 and 2 strides by chance, 2 and 2 planned: ratio 2, residuals 2 and -2.
TEST(StrideSessions, RatioHasTheSpreadOfItsSessions) {
  SessionScore score;
  score.sessions = 2.0;
  score.strides = {8.0, 4.0, 8.0, 8.0, 8.0};
  score.squares = {40.0, 8.0, 40.0, 40.0, 40.0};
  score.with_chance = {40.0, 16.0, 40.0, 40.0, 40.0};
  const auto ratio = score.fewer(NextBy::plan);
  EXPECT_EQ(ratio.value, 2.0);
  EXPECT_NEAR(ratio.ci95_high - ratio.value, 1.96 * std::sqrt(8.0 * 2.0) / 4.0, 1e-3);
  EXPECT_EQ(score.fewer(NextBy::oracle).ci95_low, 1.0);
}

}  // namespace
}  // namespace sandhopper
