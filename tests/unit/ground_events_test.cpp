#include "terrain/ground_events.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <random>
#include <type_traits>
#include <vector>

#include "terrain/normal_test.hpp"
#include "tests/unit/allocation_guard.hpp"

namespace sandhopper {
namespace {

constexpr double kRadius_m = 0.040;

// A push to `depth_m` from `speed_mps` at 1 kHz and back out, with the bed's true force and 0.5 N of noise.
GroundEventSums pushed(const Bed& bed, unsigned seed, double depth_m = 0.040, double speed_mps = 0.8) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> noise(0.0, 0.5);
  GroundEventRecorder recorder({}, kRadius_m);
  recorder.restart(0.0);
  const double rate = speed_mps / depth_m;
  double deepest = 0.0;
  for (double t = 1e-3; rate * t < 3.1; t += 1e-3) {
    const double z = depth_m * std::sin(rate * t), v = speed_mps * std::cos(rate * t), a = -rate * rate * z;
    const double force = bed.reaction({z, v, deepest, 0.0}).at_acceleration(-a) + noise(engine);
    deepest = std::max(deepest, z);
    recorder.add({.depth_m = z,
                  .speed_mps = v,
                  .accel_mps2 = a,
                  .force_N = force,
                  .leg_rate_mps = -v,
                  .since_contact_s = t,
                  .duration_s = 1e-3});
  }
  return recorder.sums();
}

Bed bed_of(const BedFamilyParameters& family, unsigned seed) {
  std::mt19937 engine(1000 + seed);
  std::normal_distribution<double> normal;
  BedFluctuation fluctuation{.relative = 0.02};
  for (auto& knot : fluctuation.knots) knot = normal(engine);
  return {BedParameters{}, kRadius_m, fluctuation, family};
}

TEST(GroundEvents, FindsTheRuptureOfACrustAndItsDepth) {
  const auto crust = bed_family_of(BedFamily::crust);
  for (unsigned seed = 0; seed < 20; ++seed) {
    const auto found = find_ground_events(pushed(bed_of(crust, seed), seed), {}).rupture;
    ASSERT_EQ(found.kind, GroundEventKind::crust_rupture) << found.statistic;
    EXPECT_NEAR(found.depth_m, crust.rupture_depth_m(), 0.0015);
    EXPECT_GT(found.size, 10.0);
    EXPECT_GT(found.speed_mps, 0.5);
  }
}

TEST(GroundEvents, FindsTheBoundaryOfTwoLayers) {
  for (const auto family : {BedFamily::soft_over_stiff, BedFamily::stiff_over_soft}) {
    const auto layers = bed_family_of(family);
    const auto found = find_ground_events(pushed(bed_of(layers, 3), 3), {}).boundary;
    ASSERT_EQ(found.kind, GroundEventKind::layer_boundary) << name_of(family) << " " << found.statistic;
    EXPECT_NEAR(found.depth_m, layers.boundary_depth_m, 0.004);
    EXPECT_EQ(found.size > 0.0, family == BedFamily::soft_over_stiff);
  }
}

TEST(GroundEvents, FindsTheFloorOfTheBox) {
  BedFamilyParameters box;
  box.floor_depth_m = 0.035;
  const auto found = find_ground_events(pushed(bed_of(box, 4), 4), {}).boundary;
  ASSERT_EQ(found.kind, GroundEventKind::box_floor);
  EXPECT_NEAR(found.depth_m, 0.035, 0.002);
}

TEST(GroundEvents, FindsSuctionWhileTheFootLeaves) {
  const auto wet = bed_family_of(BedFamily::wet);
  const auto found = find_ground_events(pushed(bed_of(wet, 5), 5), {}).suction;
  ASSERT_EQ(found.kind, GroundEventKind::suction) << found.statistic;
  // The smooth part of the null hypothesis absorbs some of the 10 N.
  EXPECT_GT(found.size, 0.5 * wet.suction_Pa * 0.005027);
  EXPECT_LT(found.size, 1.2 * wet.suction_Pa * 0.005027);
  EXPECT_NEAR(found.depth_m, 0.040, 0.006);
}

TEST(GroundEvents, SmoothBedsGiveFalseAlarmsNoMoreOftenThanStated) {
  constexpr int kPushes = 300;
  int rupture = 0, boundary = 0, suction = 0;
  for (unsigned seed = 0; seed < kPushes; ++seed) {
    BedFamilyParameters family = bed_family_of(seed % 2 == 0 ? BedFamily::power_law : BedFamily::compacted);
    if (seed % 2 == 0) family.exponent = 0.8 + seed / static_cast<double>(kPushes);
    const auto found = find_ground_events(
        pushed(bed_of(family, seed), seed, 0.02 + 1e-4 * (seed % 200), 0.4 + 0.002 * seed), {});
    rupture += found.rupture.kind != GroundEventKind::none;
    boundary += found.boundary.kind != GroundEventKind::none;
    suction += found.suction.kind != GroundEventKind::none;
  }
  EXPECT_LE(rupture, 3);
  EXPECT_LE(boundary, 3);
  EXPECT_LE(suction, 3);
}

TEST(GroundEvents, AccumulatesWithoutAllocatingInBoundedMemory) {
  static_assert(std::is_trivially_copyable_v<GroundEventSums>);
  EXPECT_LE(sizeof(GroundEventSums), 12000U);
  GroundEventRecorder recorder({}, kRadius_m);
  const AllocationGuard guard;
  recorder.restart(0.0);
  for (int i = 1; i < 2000; ++i)
    recorder.add({1e-4 * i, i < 1000 ? 0.1 : -0.1, 0.0, 0.15 * i, 0.0, 1e-3 * i, 1e-3});
  EXPECT_EQ(guard.count(), 0U);
  EXPECT_GT(recorder.sums().down.out_of_range, 0);
}

TEST(GroundEvents, InTheCraterCountsOnlyNewGround) {
  GroundEventRecorder recorder({}, kRadius_m);
  recorder.restart(0.020);
  recorder.add({0.010, 0.5, 0.0, 5.0, 0.0, 1e-3, 1e-3});
  recorder.add({0.021, 0.5, 0.0, 5.0, 0.0, 2e-3, 1e-3});
  float samples = 0.0F;
  for (const auto& bin : recorder.sums().down.bin) samples += bin.samples;
  EXPECT_EQ(samples, 1.0F);
}

TEST(GroundEvents, OfTooFewSamplesAreNone) {
  const auto found = find_ground_events(GroundEventSums{}, {});
  EXPECT_EQ(found.rupture.kind, GroundEventKind::none);
  EXPECT_EQ(found.suction.kind, GroundEventKind::none);
}

TEST(NormalTest, StatisticExceedsItsQuantileNoMoreOftenThanStated) {
  constexpr int kDraws = 4000, kPoints = 40;
  std::mt19937 engine(9);
  std::normal_distribution<double> normal;
  std::vector<double> shape(kPoints);
  for (std::size_t i = 0; i < kPoints; ++i) shape[i] = i > 10 && i < 16 ? 1.0 : 0.0;
  int beyond = 0;
  const double limit = chi_squared_1_quantile(0.05);
  EXPECT_NEAR(limit, 3.841, 0.001);
  for (int draw = 0; draw < kDraws; ++draw) {
    NormalTest test(kPoints, 2);
    const double a = 30.0 * normal(engine), b = 30.0 * normal(engine);
    for (std::size_t i = 0; i < kPoints; ++i)
      test.observe(i, a + b * static_cast<double>(i) / kPoints + normal(engine));
    test.add_covariance([](std::size_t i, std::size_t j) { return i == j ? 1.0 : 0.0; });
    test.add_term(30.0, [](std::size_t) { return 1.0; });
    test.add_term(30.0, [](std::size_t i) { return static_cast<double>(i) / kPoints; });
    beyond += test.test(shape).statistic > limit;
  }
  // At most the stated probability, and not far below: the estimated scale is at least 1.
  EXPECT_LE(beyond, 0.055 * kDraws);
  EXPECT_GE(beyond, 0.02 * kDraws);
}

TEST(NormalTest, FindsTheSizeOfItsTemplate) {
  std::vector<double> shape(30, 0.0);
  shape[12] = 1.0;
  NormalTest test(30, 1);
  for (std::size_t i = 0; i < 30; ++i) test.observe(i, 2.0 + (i == 12 ? 7.0 : 0.0));
  test.add_covariance([](std::size_t i, std::size_t j) { return i == j ? 0.01 : 0.0; });
  test.add_term(100.0, [](std::size_t) { return 1.0; });
  const auto found = test.test(shape);
  EXPECT_NEAR(found.size, 7.0, 1e-3);
  EXPECT_GT(found.statistic, 50.0);
}

}  // namespace
}  // namespace sandhopper
