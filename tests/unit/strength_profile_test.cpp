#include "terrain/strength_profile.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "terrain/ground_summary.hpp"
#include "tests/unit/allocation_guard.hpp"
#include "tests/unit/profile_pushes.hpp"

namespace sandhopper {
namespace {

TEST(StrengthProfile, FollowsCurvesThatAreNoLine) {
  for (const Curve& curve : {Curve(line_N), Curve(power_N), Curve(layers_N)}) {
    const auto solver = solved(curve, {});
    for (double z = 0.003; z < 0.042; z += 0.001) {
      const auto force = solver.force_N(z);
      EXPECT_NEAR(force.value, curve(z), 0.12 * curve(z) + 1.0) << z;
    }
  }
}

TEST(StrengthProfile, BandHoldsTheCurveInNineteenOfTwentyDepths) {
  double inside = 0.0, all = 0.0;
  std::mt19937 engine(3);
  std::normal_distribution<double> drift(0.0, 0.005);
  for (unsigned seed = 1; seed <= 40; ++seed)
    for (const Curve& curve : {Curve(line_N), Curve(power_N), Curve(layers_N)}) {
      const auto solver =
          solved(curve, {.speed_mps = 0.3 + 0.02 * seed, .depth_drift_mps = drift(engine), .seed = seed});
      for (double z = 0.003; z < 0.042; z += 0.001) {
        const auto force = solver.force_N(z);
        inside += force.low() < curve(z) && curve(z) < force.high();
        all += 1.0;
      }
    }
  EXPECT_GE(inside / all, 0.93);
}

TEST(StrengthProfile, BandWidensWhereTheFootWasNot) {
  const auto solver = solved(line_N, {.to_m = 0.025});
  const auto& p = solver.profile();
  EXPECT_LT(p.depth_max_m, 0.025);
  EXPECT_GT(solver.force_N(0.050).sd, 4.0 * solver.force_N(0.020).sd);
  EXPECT_FALSE(std::isfinite(solver.force_N(kProfileDepth_m + 0.001).value));
}

// A stiff layer, in which the curve falls at its lower boundary.
double stiff_layer_N(double z) {
  if (z < 0.015) return 3000.0 * z;
  return z < 0.020 ? 45.0 - 3000.0 * (z - 0.015) : 30.0 + 1000.0 * (z - 0.020);
}

// An error of the depth moves a curve that falls as much as one that rises.
TEST(StrengthProfile, BandCountsTheDepthErrorWhereTheCurveFalls) {
  constexpr double kSurface_sd_m = 0.001;
  const auto sd_N = [](double surface_sd_m, double depth_m) {
    StiffnessConfig config = without_steady_drag();
    config.profile->surface_sd_m = surface_sd_m;
    ProfileSolver solver(config);
    solver.add(sums_of(stiff_layer_N, {}), 1);
    return solver.force_N(depth_m).sd;
  };
  for (const double depth_m : {0.010, 0.0175}) {
    EXPECT_GT(sd_N(kSurface_sd_m, depth_m), 0.8 * 3000.0 * kSurface_sd_m) << depth_m;
    EXPECT_LT(sd_N(1e-6, depth_m), 0.6 * 3000.0 * kSurface_sd_m) << depth_m;
  }
}

// On ground prepared alike: in a crater a stride has no samples above the depth of the one before.
TEST(StrengthProfile, PosteriorOfAStrideIsThePriorOfTheNext) {
  ProfileSolver solver(without_steady_drag());
  solver.add(sums_of(line_N, {.speed_mps = 0.5, .to_m = 0.025}), 1);
  const double deep_before = solver.force_N(0.035).sd, shallow_before = solver.force_N(0.015).sd;
  solver.add(sums_of(line_N, {.speed_mps = 1.0, .to_m = 0.045, .seed = 2}), ProfileSolver::kFreshGround);
  EXPECT_LT(solver.force_N(0.035).sd, 0.6 * deep_before);
  EXPECT_LT(solver.force_N(0.015).sd, shallow_before);
  EXPECT_NEAR(solver.force_N(0.035).value, line_N(0.035), 3.0 * solver.force_N(0.035).sd);
  EXPECT_EQ(solver.profile().stride, 2u);
}

TEST(StrengthProfile, StrideWithoutNewGroundLeavesItAsItIs) {
  auto solver = solved(line_N, {});
  const auto before = solver.force_N(0.030);
  solver.add({}, 2);
  EXPECT_EQ(solver.force_N(0.030).value, before.value);
  EXPECT_EQ(solver.force_N(0.030).sd, before.sd);
}

TEST(StrengthProfile, AccumulatesAndSolvesWithoutAllocating) {
  ProfileRegression regression({}, kRadius_m, kReducedMass_kg);
  ProfileSolver solver{StiffnessConfig{}};
  const AllocationGuard guard;
  for (int i = 1; i < 300; ++i) regression.add({1e-4 * i, 0.1, 0.0, 0.15 * i, 0.0, 1e-3 * i, 1e-3}, 0.15 * i);
  solver.add(regression.sums(), 1);
  summarise(solver);
  EXPECT_EQ(guard.count(), 0u);
}

TEST(GroundSummary, SaysWhichBedsAreNoLine) {
  int lines = 0, wrong = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const auto shape = [&](const Curve& curve) {
      const Push push{.speed_mps = 0.8, .seed = seed};
      return summarise(solved(curve, push));
    };
    const auto line = shape(line_N);
    lines += line.line_valid;
    EXPECT_NEAR(line.line_N_per_m.value, 1500.0,
                4.0 * (line.line_N_per_m.ci95_high - line.line_N_per_m.value) / 1.96);
    wrong += shape(power_N).line_valid + shape(layers_N).line_valid;
  }
  EXPECT_GE(lines, 18);
  EXPECT_LE(wrong, 1);
}

TEST(GroundSummary, FindsThePowerLawsExponent) {
  const auto g = summarise(solved(power_N, {}));
  EXPECT_EQ(g.shape, GroundShape::power_law);
  EXPECT_LT(g.exponent.ci95_low, 1.4);
  EXPECT_GT(g.exponent.ci95_high, 1.4);
}

constexpr double kFoot_kg = 0.68;

// A foot that leaves along a line of this stiffness: its load falls from 60 N to 0 in 0.1 s. `bias_mps2`:
// bias of its accelerometer.
UnloadingTrace leaving(double line_N_per_m, double bias_mps2 = 0.05) {
  UnloadingRecorder recorder(0.03);
  std::mt19937 engine(5);
  std::normal_distribution<double> noise;
  const double damping = 2.0 * 0.6 * std::sqrt(line_N_per_m * kFoot_kg);
  double z = 60.0 / line_N_per_m, v = 0.0;
  const double step_s = 1e-5;
  double load_N = 60.0;
  for (int i = 0; i < 12000 && load_N > 0.5; ++i) {
    const double t = i * step_s;
    load_N = 30.0 * (1.0 + std::cos(std::numbers::pi * t / 0.1));
    const double ground_N = line_N_per_m * z + damping * v;
    const double a = (load_N - ground_N) / kFoot_kg;
    v += a * step_s;
    z += v * step_s;
    if (i % 100 == 0)
      recorder.add({.depth_m = 0.038,
                    .speed_mps = v,
                    .accel_mps2 = a + bias_mps2 + 0.3 * noise(engine),
                    .force_N = ground_N + 0.3 * noise(engine),
                    .leg_rate_mps = 0.0,
                    .since_contact_s = t,
                    .duration_s = 1e-3});
  }
  recorder.add({.depth_m = 0.037,
                .speed_mps = -0.2,
                .accel_mps2 = -40.0,
                .force_N = 0.0,
                .leg_rate_mps = 0.0,
                .since_contact_s = 0.1,
                .duration_s = 1e-3});
  return recorder.trace();
}

ReloadingLine line_of(const UnloadingTrace& trace, int strides = 1) {
  ReloadingPosterior posterior({}, 0.5, 0.02);
  for (int i = 0; i < strides; ++i) posterior.add(trace, kFoot_kg);
  return posterior.line();
}

TEST(ReloadingStiffness, IntervalHoldsTheLineOnWhichTheFootLeaves) {
  for (const double truth : {20e3, 45e3}) {
    const auto k = line_of(leaving(truth));
    EXPECT_NEAR(k.value_N_per_m, truth, 0.25 * truth);
    EXPECT_LT(k.ci95_low_N_per_m, truth);
    EXPECT_GT(k.ci95_high_N_per_m, truth);
    EXPECT_LT(k.ci95_high_N_per_m, 2.0 * truth);
  }
}

// The interval must contain the true value also between two grid points. With many strides it becomes
// narrower than the grid, down to the error of the torque constant: 2 x 1.96 x 2 %.
TEST(ReloadingStiffness, IsFinerThanTheGrid) {
  int holds = 0, lines = 0;
  for (double truth = 25e3; truth < 50e3; truth *= 1.05) {
    const auto trace = leaving(truth);
    const auto one = line_of(trace), many = line_of(trace, 25);
    holds += one.ci95_low_N_per_m < truth && truth < one.ci95_high_N_per_m;
    EXPECT_LT(many.ci95_high_N_per_m, 1.25 * many.ci95_low_N_per_m) << truth;
    EXPECT_GT(many.ci95_high_N_per_m, 1.08 * many.ci95_low_N_per_m) << truth;
    ++lines;
  }
  EXPECT_GE(holds, lines - 2);
}

TEST(ReloadingStiffness, IsNotMovedByTheAccelerometersBias) {
  const auto with = line_of(leaving(45e3, 0.2)), without = line_of(leaving(45e3, 0.0));
  EXPECT_NEAR(with.value_N_per_m, without.value_N_per_m, 0.15 * without.value_N_per_m);
}

TEST(ReloadingStiffness, OfRigidGroundIsALowerBound) {
  const auto k = line_of(leaving(1e7));
  EXPECT_GT(k.ci95_low_N_per_m, 50e3);
  EXPECT_FALSE(std::isfinite(k.ci95_high_N_per_m));
}

TEST(ReloadingStiffness, StridesOfATrialNarrowIt) {
  const auto one = line_of(leaving(45e3)), four = line_of(leaving(45e3), 4);
  EXPECT_LT(four.ci95_high_N_per_m - four.ci95_low_N_per_m,
            0.9 * (one.ci95_high_N_per_m - one.ci95_low_N_per_m));
}

TEST(ReloadingStiffness, OfAnImpactIsNotKnown) {
  UnloadingRecorder recorder(0.03);
  for (int i = 0; i < 60; ++i)
    recorder.add({.depth_m = 0.03,
                  .speed_mps = -0.01,
                  .accel_mps2 = -70.0,
                  .force_N = 60.0 - i,
                  .leg_rate_mps = 0.0,
                  .since_contact_s = 1e-3 * i,
                  .duration_s = 1e-3});
  EXPECT_EQ(recorder.trace().pairs, 0);
  EXPECT_EQ(line_of(recorder.trace()).value_N_per_m, 0.0);
}

TEST(GroundSummary, LineIsTheJointFits) {
  const auto sums = sums_of(line_N, {});
  const Bed cone(BedParameters{}, kRadius_m);
  JointRegression joint({}, kRadius_m);
  std::mt19937 engine(1);
  std::normal_distribution<double> noise(0.0, 0.3);
  const Push push;
  const double rate = push.speed_mps / push.to_m;
  for (double t = 1e-3; rate * t < 3.5; t += 1e-3) {
    const double z = push.to_m * (1.0 - std::exp(-rate * t));
    const double v = push.speed_mps * std::exp(-rate * t), a = -rate * v;
    const double force = line_N(z) + cone.added_mass_gradient_kg_per_m(z) * v * v + cone.added_mass_kg(z) * a;
    joint.add({z, v, a, force + noise(engine), -0.1, t, 1e-3});
  }
  const auto direct = solve_joint(joint.sums(), {});
  const auto through = solve_joint(joint_sums_of(sums, {}), {});
  EXPECT_NEAR(through.value_N_per_m, direct.value_N_per_m, 1e-6 * direct.value_N_per_m);
  EXPECT_NEAR(through.ci95_low_N_per_m, direct.ci95_low_N_per_m, 1e-6 * direct.value_N_per_m);
  EXPECT_NEAR(through.chi_squared, direct.chi_squared, 1e-6);
  ProfileSolver solver{StiffnessConfig{}};
  solver.add(sums, 1);
  EXPECT_NEAR(summarise(solver).line_N_per_m.value, direct.value_N_per_m, 1e-6 * direct.value_N_per_m);
}

TEST(StrengthProfile, WhatAnAccelerometerCutOffIsNotUsedForThreeSamples) {
  ProfileRegression regression({}, kRadius_m, kReducedMass_kg);
  regression.add({0.010, 0.5, -147.0, 90.0, 0.0, 1e-3, 1e-3}, 20.0);
  for (int i = 2; i <= 4; ++i)
    regression.add({0.010 + 1e-4 * i, 0.5, -70.0, 60.0, 0.0, 1e-3 * i - 1e-4, 1e-3}, 20.0);
  EXPECT_EQ(regression.sums().samples, 0);
  EXPECT_EQ(regression.sums().saturated, 1);
  regression.add({0.0106, 0.5, -70.0, 60.0, 0.0, 5e-3, 1e-3}, 20.0);
  EXPECT_EQ(regression.sums().samples, 1);
}

TEST(StrengthProfile, StepOfTheTorqueIsNotUsedForThreeSamples) {
  ProfileRegression regression({}, kRadius_m, kReducedMass_kg);
  regression.on_phase_change(1e-3);
  for (int i = 2; i <= 6; ++i) {
    regression.add({0.010 + 1e-4 * i, 0.5, -20.0, 60.0, 0.0, 1e-3 * i - 1e-4, 1e-3}, 20.0);
    EXPECT_EQ(regression.sums().samples, std::max(0, i - 4));
  }
}

}  // namespace
}  // namespace sandhopper
