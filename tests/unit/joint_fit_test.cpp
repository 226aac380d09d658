#include "terrain/joint_fit.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <random>

#include "tests/unit/allocation_guard.hpp"

namespace sandhopper {
namespace {

constexpr double kRadius_m = 0.040;

struct Ground {
  double stiffness_N_per_m = 1500.0;
  double added_mass_factor = 1.0;
  double intercept_depth_m = 0.003;
};

// A push to `depth_m` that starts at `speed_mps`, rests half-way and goes on, as in a hop.
struct Push {
  double speed_mps = 0.8;
  double depth_m = 0.040;
  double depth_drift_mps = 0.0;
  double noise_N = 0.0;
  double force_scale = 1.0;
  double fluctuation = 0.0;
  unsigned seed = 1;
};

JointSums sums_of(const Ground& ground, const Push& push, const JointConfig& config = {}) {
  BedParameters p;
  p.stiffness_N_per_m = ground.stiffness_N_per_m;
  p.added_mass_factor = ground.added_mass_factor;
  p.intercept_depth_m = ground.intercept_depth_m;
  std::mt19937 engine(push.seed);
  BedFluctuation fluctuation;
  fluctuation.relative = push.fluctuation;
  std::normal_distribution<double> standard;
  for (auto& knot : fluctuation.knots) knot = standard(engine);
  const Bed bed(p, kRadius_m, fluctuation);
  std::normal_distribution<double> normal(0.0, push.noise_N);
  JointRegression regression(config, kRadius_m);
  const double half = 0.5 * push.depth_m;
  double start_s = 0.0;
  for (const double from : {0.0, half}) {
    // Sine-shaped motion: the speed falls from `v` to zero over half the depth.
    const double v = from == 0.0 ? push.speed_mps : 0.6 * push.speed_mps;
    const double rate = v / half;
    for (double t = 1e-3; rate * t < 1.5; t += 1e-3) {
      const double z = from + half * std::sin(rate * t);
      const double speed = v * std::cos(rate * t);
      const double accel = -v * rate * std::sin(rate * t);
      const double force =
          bed.reaction({z, speed, z, 0.0}).at_acceleration(-accel) * push.force_scale + normal(engine);
      regression.add({z + push.depth_drift_mps * (start_s + t), speed, accel, force, from == 0.0 ? -0.1 : 0.1,
                      start_s + t, 1e-3});
    }
    start_s += 0.2;
  }
  return regression.sums();
}

TEST(JointFit, FindsStiffnessAddedMassAndInterceptWhereDragBendsTheLine) {
  for (const double k : {1000.0, 1500.0, 3000.0})
    for (const double factor : {0.5, 1.0, 2.0}) {
      const auto e = solve_joint(sums_of({k, factor, 0.003}, {}), {});
      EXPECT_EQ(e.validity, Validity::valid);
      EXPECT_NEAR(e.value_N_per_m, k, 0.01 * k);
      EXPECT_NEAR(e.added_mass_factor, factor, 0.05);
      EXPECT_NEAR(e.intercept_depth_m, 0.003, 0.0005);
    }
}

TEST(JointFit, IsNotLedAstrayByADepthThatDrifts) {
  const auto sums = sums_of({}, {.depth_drift_mps = 0.005});
  StiffnessConfig believing;
  believing.joint.depth_drift_sd_mps = 1e-6;
  const double believed = solve_joint(sums, believing).value_N_per_m;
  const auto e = solve_joint(sums, {});
  EXPECT_LT(believed, 1450.0);
  EXPECT_LT(std::abs(e.value_N_per_m - 1500.0), 0.75 * std::abs(believed - 1500.0));
  EXPECT_LT(e.depth_drift_mps, -0.001);  // the true depth increases more slowly than the estimated one
  EXPECT_GT(e.depth_drift_mps, -0.006);
}

TEST(JointFit, HoldsAddedMassAtZeroWhereTheDataWantItNegative) {
  Push push;
  JointConfig config;
  auto sums = sums_of({1500.0, 0.0, 0.003}, push, config);
  // A force that falls with speed, which no bed does.
  sums.moment[2] -= 0.3 * sums.normal[kJointTerms * 2 + 2];
  const auto e = solve_joint(sums, {});
  EXPECT_NEAR(e.added_mass_factor, 0.0, 1e-6);
}

TEST(JointFit, IntervalHoldsTheTruthInNineteenOfTwentyPushes) {
  int inside = 0;
  constexpr int kPushes = 400;
  std::mt19937 engine(7);
  std::normal_distribution<double> normal;
  for (unsigned i = 0; i < kPushes; ++i) {
    const auto e = solve_joint(sums_of({}, {.speed_mps = 0.4 + 0.002 * i,
                                            .depth_drift_mps = 0.005 * normal(engine),
                                            .noise_N = 0.5,
                                            .force_scale = 1.0 + 0.02 * normal(engine),
                                            .fluctuation = 0.02,
                                            .seed = i}),
                               {});
    inside += e.ci95_low_N_per_m < 1500.0 && 1500.0 < e.ci95_high_N_per_m;
  }
  EXPECT_GE(inside, static_cast<int>(0.93 * kPushes));
  EXPECT_LE(inside, static_cast<int>(0.995 * kPushes));
}

TEST(JointFit, RefusesWhatCannotTell) {
  const StiffnessConfig config;
  EXPECT_EQ(solve_joint({}, config).validity, Validity::no_new_penetration);
  EXPECT_EQ(solve_joint(sums_of({}, {.depth_m = 0.004}), config).validity, Validity::too_few_samples);
  JointConfig fine;
  fine.fluctuation_length_m = 1e-4;
  EXPECT_EQ(solve_joint(sums_of({}, {.depth_m = 0.004}, fine), config).validity, Validity::too_shallow);
  EXPECT_EQ(solve_joint(sums_of({}, {.depth_m = 0.060}), config).validity, Validity::deeper_than_foot);
  JointConfig short_range;
  short_range.accel_range_mps2 = 20.0;
  EXPECT_EQ(solve_joint(sums_of({}, {.speed_mps = 1.2}, short_range), config).validity, Validity::saturated);
}

// Sums without exp and tanh, because their last bits depend on the C library.
JointSums plain_sums() {
  JointSums sums;
  std::uint32_t state = 1;
  for (int row = 0; row < 60; ++row) {
    std::array<double, kJointTerms> x{};
    double force_N = 0.0;
    for (auto& term : x) {
      state = 1664525U * state + 1013904223U;
      term = state * 0x1p-32;
      force_N += 1500.0 * term;
    }
    for (std::size_t i = 0; i < kJointTerms; ++i) {
      for (std::size_t j = 0; j < kJointTerms; ++j) sums.normal[kJointTerms * i + j] += x[i] * x[j];
      sums.moment[i] += x[i] * force_N;
    }
    sums.force_squared += force_N * force_N;
  }
  sums.observations = 60.0;
  sums.samples = 60;
  sums.depth_max_m = 0.02;
  return sums;
}

TEST(JointFit, HasTheSameBitsOnEveryProcessor) {
  const auto e = solve_joint(plain_sums(), {});
  EXPECT_EQ(e.value_N_per_m, 0x1.84016a5e62d7ep+10) << std::hexfloat << e.value_N_per_m;
  EXPECT_EQ(e.ci95_low_N_per_m, 0x1.52c26c7d125eap+10) << std::hexfloat << e.ci95_low_N_per_m;
  EXPECT_EQ(e.added_mass_factor, 0x1.a24f06c4a6c6p+10) << std::hexfloat << e.added_mass_factor;
  EXPECT_EQ(e.joint_friction_N, 0x1.5f2a363a604fp+9) << std::hexfloat << e.joint_friction_N;
}

TEST(JointFit, AccumulatesWithoutAllocating) {
  JointRegression regression({}, kRadius_m);
  const AllocationGuard guard;
  for (int i = 1; i < 100; ++i) regression.add({1e-4 * i, 0.1, 0.0, 0.15 * i, 0.0, 1e-3 * i, 1e-3});
  EXPECT_EQ(guard.count(), 0u);
}

TEST(PooledStiffness, NarrowsWithStridesButNotBelowTheForceScale) {
  const JointConfig config;
  std::vector<JointEstimate> strides;
  PooledStiffness last;
  double width_of_three = 0.0;
  for (unsigned i = 0; i < 40; ++i) {
    strides.push_back(solve_joint(sums_of({}, {.noise_N = 0.5, .seed = i}), {}));
    last = pool_strides(strides, config);
    if (i == 2) width_of_three = last.ci95_high_N_per_m - last.ci95_low_N_per_m;
  }
  const double width = last.ci95_high_N_per_m - last.ci95_low_N_per_m;
  EXPECT_EQ(last.strides, 40);
  EXPECT_NEAR(last.value_N_per_m, 1500.0, 30.0);
  EXPECT_LT(width, 0.8 * width_of_three);
  EXPECT_GT(width, 2.0 * 1.96 * 0.02 * 1500.0);
}

TEST(Student, QuantilesAreThoseOfTheTable) {
  EXPECT_NEAR(student_975(3), 3.182, 0.04);
  EXPECT_NEAR(student_975(5), 2.571, 0.005);
  EXPECT_NEAR(student_975(10), 2.228, 0.001);
  EXPECT_NEAR(student_975(30), 2.042, 0.001);
}

}  // namespace
}  // namespace sandhopper
