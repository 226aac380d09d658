#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "estimation/kalman_filter.hpp"
#include "firmware/stride_recorder.hpp"
#include "terrain/strength_profile.hpp"

namespace sandhopper {
namespace {

constexpr double kRadius_m = 0.040;
constexpr double kReducedMass_kg = 0.68;

double hardening_N(double z) { return believed_force_N({}, z) + 1e5 * z * z; }

// A slow push on `curve_N`; without it on the bed that the prior assumes.
ProfileSums slow_push(double from_m, double to_m, double duration_s = 1e-3, double too_deep_m = 0.0,
                      const std::function<double(double)>& curve_N = {}) {
  ProfileRegression regression({}, kRadius_m, kReducedMass_kg);
  constexpr double kSpeed_mps = 0.1;
  double t = 1e-3;
  for (double z = from_m; z < to_m; z += 1e-3 * kSpeed_mps, t += 1e-3) {
    const double force = curve_N ? curve_N(z) : believed_force_N({}, z);
    regression.add({z + too_deep_m, kSpeed_mps, 0.0, force, 0.0, t, duration_s}, force);
  }
  return regression.sums();
}

// A sample with almost no weight.
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

// Spread of the height filter's error at this time since contact.
double filter_error_m(double time_s) {
  const ProfileConfig prior;
  const double phase = prior.filter_decay_per_s * time_s;
  return prior.filter_sd_m * std::sqrt(2.0 - 2.0 * std::exp(-phase) * std::cos(phase));
}

// The variance of a stationary error with the correlation exp(-a t) cos(a t) falls at the rate of its
// covariance with the speed's error.
TEST(ProfileConfig, DepthErrorIsThatOfTheKalmanFilter) {
  KalmanFilter filter{KalmanConfig{}};
  filter.reset({0.5, 0.0, 0.1, 0.0});
  for (int cycle = 0; cycle < 3000; ++cycle) {
    filter.predict({0.0, 0.0}, 1e-3);
    if (cycle % 2 == 0) filter.update_body_height(0.5, 2e-3);
    filter.update_leg_length(0.4, 1e-3);
    filter.update_leg_rate(0.0, 1e-3);
  }
  const double variance_m2 = filter.covariance()(2, 2);
  const ProfileConfig prior;
  EXPECT_NEAR(prior.filter_decay_per_s, filter.covariance()(2, 3) / variance_m2, 0.3);
  EXPECT_NEAR(prior.filter_sd_m, std::sqrt(variance_m2), 0.1e-3);
}

double hardening_N_per_m(double z) { return (hardening_N(z + 1e-3) - hardening_N(z - 1e-3)) / 2e-3; }

// A bed that becomes stiffer than believed looks like a foot that is less deep than estimated.
TEST(ProfileMemory, ACurveDoesNotShowTheDepthInAFirstStride) {
  ProfileSolver solver{StiffnessConfig{}};
  solver.add(slow_push(1e-4, 0.035, 1e-3, 0.0, hardening_N), 1);
  const ProfileConfig prior;
  constexpr double kSpeed_mps = 0.1;
  for (double z = 0.010; z < 0.033; z += 0.0025) {
    const auto force = solver.force_N(z);
    EXPECT_NEAR(force.value, hardening_N(z), 2e-4 * hardening_N_per_m(z)) << z;
    const double depth_sd_m = std::hypot(prior.surface_sd_m, filter_error_m(z / kSpeed_mps));
    EXPECT_GT(force.sd, 0.95 * depth_sd_m * hardening_N_per_m(z)) << z;
  }
}

TEST(ProfileMemory, ACurveInACraterDoesNotShowTheDepth) {
  ProfileSolver solver{StiffnessConfig{}};
  const auto first = slow_push(1e-4, 0.020, 1e-3, 0.0, hardening_N);
  solver.add(first, 1);
  const ProfileConfig prior;
  const double landing_m = prior.landing_depth_sd_m;
  const double crater_sd_m = std::hypot(prior.surface_sd_m, filter_error_m(first.last_s));
  for (const double too_deep_m : {-landing_m, 0.0, landing_m}) {
    ProfileSolver later = solver;
    later.add(slow_push(0.020, 0.035, 1e-3, too_deep_m, hardening_N), 2);
    for (double z = 0.025; z < 0.033; z += 0.0025) {
      const auto force = later.force_N(z);
      EXPECT_LT(force.low(), hardening_N(z)) << z;
      EXPECT_GT(force.high(), hardening_N(z)) << z;
      EXPECT_GT(force.sd, 0.9 * std::hypot(crater_sd_m, landing_m) * hardening_N_per_m(z)) << z;
    }
  }
}

// The depths of both strides are wrong by the same amount, so the curve between them is as certain as that of
// a single stride.
TEST(ProfileMemory, LaterStrideBeginsWithTheDepthErrorOfItsCrater) {
  StiffnessConfig config;
  config.profile = ProfileConfig{.landing_depth_sd_m = 1e-6};
  ProfileSolver two(config), one(config);
  two.add(slow_push(1e-4, 0.020), 1);
  two.add(slow_push(0.020, 0.035), 2);
  one.add(slow_push(1e-4, 0.035), 1);
  EXPECT_LT(tangent_at(two.profile(), 0.021).sd, 1.3 * tangent_at(one.profile(), 0.021).sd);
}

TEST(ProfileMemory, DriftAndLagInACraterCountFromTheFirstSampleOnNewGround) {
  ProfileRegression regression({}, kRadius_m, kReducedMass_kg);
  regression.on_contact(0.8, true);
  regression.add({0.0300, 0.5, 0.0, 60.0, 0.0, 0.100, 1e-3}, 20.0);
  EXPECT_EQ(regression.sums().last_s, 0.0);
  EXPECT_EQ(regression.sums().last_change_mps, 0.0);
  regression.add({0.0305, 0.3, 0.0, 60.0, 0.0, 0.102, 1e-3}, 20.0);
  EXPECT_NEAR(regression.sums().last_s, 0.002, 1e-12);
  EXPECT_NEAR(regression.sums().last_change_mps, -0.2, 1e-12);
  regression.reset();
  regression.on_contact(0.8);
  regression.add({0.0010, 0.75, 0.0, 6.0, 0.0, 0.001, 1e-3}, 20.0);  // still disturbed by the blow
  EXPECT_EQ(regression.sums().samples, 0);
  regression.add({0.0032, 0.7, 0.0, 6.0, 0.0, 0.004, 1e-3}, 20.0);
  EXPECT_NEAR(regression.sums().last_s, 0.004, 1e-12);
  EXPECT_NEAR(regression.sums().last_change_mps, -0.1, 1e-12);
}

// All depths of a stride are too small by the depth at contact, and its curve is corrected for that.
TEST(ProfileMemory, TheExpectedDepthAtContactShiftsTheCurve) {
  ProfileSums sums = slow_push(1e-4, 0.030);
  ProfileSolver surface{StiffnessConfig{}}, late{StiffnessConfig{}};
  surface.add(sums, 1);
  sums.contact_mps = 0.1;
  late.add(sums, 1);
  const double depth_m = late.contact_depth(0.1, 0.0).mean_m;
  EXPECT_GT(depth_m, 2e-4);
  for (double z = 0.010; z < 0.028; z += 0.0025) {
    const double change_N = tangent_at(surface.profile(), z).value * depth_m;
    EXPECT_NEAR(surface.force_N(z).value - late.force_N(z).value, change_N, 0.2 * change_N) << z;
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

// Estimates for a foot on the assumed bed, one per millisecond.
class PushedFoot {
 public:
  PushedFoot() { recorder.on_release(0); }
  void move(double speed_mps, State state) {
    now_ns_ += 1'000'000;
    depth_m += 1e-3 * speed_mps;
    Estimate e;
    e.foot_z_m = -depth_m;
    e.force_depth_m = depth_m;
    e.force_velocity_mps = speed_mps;
    e.force_time_ns = now_ns_;
    e.direct_force_N = 5.0 + 1500.0 * depth_m - unloaded_N;
    recorder.update(e, state);
  }
  void touch_down() { recorder.on_touchdown(now_ns_); }
  void lift_off() { recorder.on_liftoff(now_ns_); }

  StrideRecorder recorder{{}, {kRadius_m, kReducedMass_kg}};
  double depth_m = 0.0;
  double unloaded_N = 0.0;  // force that is missing while the foot is in its own crater

 private:
  std::int64_t now_ns_ = 0;
};

// A foot that goes down and then rests, while the estimated depth drifts.
TEST(StrideRecorder, DriftOfAFootAtRestIsNoNewDepth) {
  PushedFoot foot;
  foot.move(0.2, State::flight);
  foot.touch_down();
  while (foot.depth_m < 0.020) foot.move(0.2, State::compression);
  while (foot.depth_m < 0.024) foot.move(0.005, State::compression);
  EXPECT_NEAR(foot.recorder.new_ground_m(), 0.020, 3e-4);
  foot.lift_off();
  foot.depth_m = 0.0;
  foot.move(0.5, State::flight);
  foot.touch_down();
  foot.lift_off();
  EXPECT_NEAR(foot.recorder.sums().summary.crater_depth_m, 0.020, 3e-4);
}

// The leg's push grows again after the impact, and the estimated speed is slightly too large.
TEST(StrideRecorder, AFootThatRestedIsOnNewGroundWhenItsForceIsThatOfTheDeepestPoint) {
  PushedFoot foot;
  foot.move(0.2, State::flight);
  foot.touch_down();
  while (foot.depth_m < 0.020) foot.move(0.2, State::compression);
  foot.move(0.0, State::compression);
  const double deepest_m = foot.recorder.new_ground_m();
  foot.unloaded_N = 20.0;
  while (foot.depth_m < 0.021) foot.move(0.04, State::compression);
  EXPECT_EQ(foot.recorder.new_ground_m(), deepest_m);
  foot.unloaded_N = 0.0;
  foot.move(0.04, State::compression);
  const double reloaded_m = foot.recorder.new_ground_m();
  EXPECT_GT(reloaded_m, deepest_m);
  // Then the force may become smaller with depth, as below a crust.
  foot.unloaded_N = 20.0;
  foot.move(0.04, State::compression);
  EXPECT_GT(foot.recorder.new_ground_m(), reloaded_m);
  foot.lift_off();
  EXPECT_GT(foot.recorder.sums().profile.samples, 0);
}

// The leg can touch down again before its foot has left a deep crater.
TEST(StrideRecorder, TouchdownBeforeTheFootIsClearBeginsNewEvents) {
  PushedFoot foot;
  foot.move(0.2, State::flight);
  foot.touch_down();
  while (foot.depth_m < 0.060) foot.move(0.2, State::compression);
  foot.lift_off();
  foot.move(-0.1, State::flight);
  foot.touch_down();
  while (foot.depth_m > 0.040) foot.move(-0.2, State::compression);
  foot.move(0.1, State::compression);
  EXPECT_TRUE(foot.recorder.foot_is_clear());
  EXPECT_EQ(foot.recorder.event_sums().stride, 1U);
  EXPECT_NEAR(foot.recorder.event_sums().deepest_m, 0.060, 3e-4);
  while (foot.depth_m < 0.065) foot.move(0.2, State::compression);
  foot.lift_off();
  const auto& sums = foot.recorder.event_sums();
  EXPECT_EQ(sums.stride, 2U);
  EXPECT_NEAR(sums.crater_depth_m, 0.060, 3e-4);
  for (std::size_t i = 0; i < 119; ++i) EXPECT_EQ(sums.down.bin[i].samples, 0.0F) << i;
  EXPECT_GT(sums.down.bin[125].samples, 0.0F);
}

}  // namespace
}  // namespace sandhopper
