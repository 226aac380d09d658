#include "terrain/strength_profile.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "terrain/ground_summary.hpp"
#include "tests/unit/allocation_guard.hpp"

namespace sandhopper {
namespace {

constexpr double kRadius_m = 0.040;
constexpr double kReducedMass_kg = 0.68;
using Curve = std::function<double(double)>;

double line_N(double z) { return 1500.0 * (z + 0.003 * (1.0 - std::exp(-z / 0.003))); }
double power_N(double z) { return 49.5 * std::pow(z / 0.030, 1.4); }
double layers_N(double z) { return line_N(z) * (0.7 + 1.8 / (1.0 + std::exp((0.020 - z) / 0.002))); }

struct Push {
  double speed_mps = 0.8;
  double to_m = 0.045;
  double noise_N = 0.3;
  double depth_drift_mps = 0.0;
  unsigned seed = 1;
};

// A foot that slows down on its way into virgin ground, on which drag and added mass act.
ProfileSums sums_of(const Curve& curve, const Push& push) {
  const Bed cone(BedParameters{}, kRadius_m);
  ProfileRegression regression({}, kRadius_m, kReducedMass_kg);
  std::mt19937 engine(push.seed);
  std::normal_distribution<double> noise(0.0, push.noise_N);
  const double rate = push.speed_mps / push.to_m;
  for (double t = 1e-3; rate * t < 3.5; t += 1e-3) {
    const double z = push.to_m * (1.0 - std::exp(-rate * t));
    const double v = push.speed_mps * std::exp(-rate * t), a = -rate * v;
    const double force = curve(z) + cone.added_mass_gradient_kg_per_m(z) * v * v + cone.added_mass_kg(z) * a;
    regression.add({z + push.depth_drift_mps * t, v, a, force + noise(engine), -0.1, t, 1e-3}, force);
  }
  return regression.sums();
}

ProfileSolver solved(const Curve& curve, const Push& push) {
  ProfileSolver solver{StiffnessConfig{}};
  solver.add(sums_of(curve, push), 1);
  return solver;
}

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

TEST(StrengthProfile, PosteriorOfAStrideIsThePriorOfTheNext) {
  ProfileSolver solver{StiffnessConfig{}};
  solver.add(sums_of(line_N, {.speed_mps = 0.5, .to_m = 0.025}), 1);
  const double deep_before = solver.force_N(0.035).sd, shallow_before = solver.force_N(0.015).sd;
  solver.add(sums_of(line_N, {.speed_mps = 1.0, .to_m = 0.045, .seed = 2}), 2);
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

// A foot that comes to rest at 38 mm under 60 N and leaves on a line of 45 kN/m.
CraterReturn leaving(double line_N_per_m) {
  CraterReturn crater;
  JointSample s{.depth_m = 0.038,
                .speed_mps = 0.05,
                .accel_mps2 = 0.0,
                .force_N = 60.0,
                .leg_rate_mps = 0.0,
                .since_contact_s = 0.2,
                .duration_s = 1e-3};
  crater.follow(s, 1.5);
  s.speed_mps = -0.2;
  while (s.force_N > 0.0) {
    s.depth_m -= 2e-4;
    s.since_contact_s += 1e-3;
    s.force_N -= 2e-4 * line_N_per_m;
    crater.follow(s, 1.5);
  }
  s.depth_m = 0.01;  // in the air
  crater.follow(s, 1.5);
  return crater;
}

TEST(ReloadingStiffness, IntervalHoldsTheLineOnWhichTheFootLeaves) {
  const auto k = reloading_stiffness(leaving(45000.0), {});
  EXPECT_NEAR(k.value, 45000.0, 5000.0);
  EXPECT_GT(k.ci95_low, 15000.0);
  EXPECT_LT(k.ci95_low, 45000.0);
  EXPECT_GT(k.ci95_high, 45000.0);
}

TEST(ReloadingStiffness, OfRigidGroundIsALowerBound) {
  const auto k = reloading_stiffness(leaving(1e6), {});
  EXPECT_GT(k.ci95_low, 20000.0);
  EXPECT_FALSE(std::isfinite(k.ci95_high));
  EXPECT_EQ(reloading_stiffness({}, {}).value, 0.0);
}

}  // namespace
}  // namespace sandhopper
