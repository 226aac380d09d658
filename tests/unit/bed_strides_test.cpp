#include "tools/experiment/bed_strides.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "terrain/ground_summary.hpp"
#include "tools/experiment/bed_score.hpp"
#include "tools/experiment/hopped_cycles.hpp"

namespace sandhopper {
namespace {

const BedCase& bed_named(const std::string& name) {
  return *std::ranges::find(bed_cases(), name, &BedCase::name);
}

BedTrial trial_on(const std::string& bed, std::uint64_t seed) {
  return run_bed_trial({}, {}, bed_named(bed), seed, 3);
}

TEST(BedTrial, LaterStridesKnowTheirDepthAfterTheBlowOfLanding) {
  double squares = 0.0, strides = 0.0;
  for (const std::uint64_t seed : {11U, 12U, 14U, 15U, 26U, 27U}) {
    const auto trial = trial_on("line", seed);
    for (const auto& stride : trial.strides) {
      if (stride.sums.summary.stride == 1) continue;
      const double error = stride.sums.summary.max_depth_m - stride.true_deepest_m;
      squares += error * error;
      strides += 1.0;
    }
  }
  ASSERT_GE(strides, 6.0);
  EXPECT_LT(std::sqrt(squares / strides), 0.0015);
}

// A foot on soft ground still sinks when the stance switches and the torque steps.
TEST(BedTrial, SamplesOfTheProfileHaveTheForceOfTheGroundAlsoWhenTheStanceSwitches) {
  CycleConfig cycle;
  cycle.limits.strides = 1;
  cycle.controller.compression_stiffness_N_per_m = 250.0;
  WorldConfig world;
  world.bed_family = bed_named("stiff_over_soft").family;
  double worst_N = 0.0;
  int after_switch = 0;
  for (std::uint64_t seed = 21; seed <= 26; ++seed) {
    HoppedCycles hop(cycle, world, {.release_height_m = 0.089, .seed = seed, .noise = true});
    double deepest_m = 0.0;
    while (hop.next() && !hop.controller().stride_finished()) {
      if (hop.controller().new_ground_m() == deepest_m) continue;
      deepest_m = hop.controller().new_ground_m();
      if (hop.output().state != State::extension) continue;
      ++after_switch;
      const double error_N = hop.output().estimate.direct_force_N - hop.truth_before().contact_force_N;
      worst_N = std::max(worst_N, std::abs(error_N));
    }
  }
  EXPECT_GE(after_switch, 20);
  EXPECT_LT(worst_N, 10.0);
}

// `hop trial` waits the same time, in which the height filter settles.
TEST(BedTrial, RobotHangsBeforeItsRelease) {
  CycleConfig cycle;
  cycle.limits.strides = 1;
  for (const std::int64_t hang_cycles : {std::int64_t{0}, kHang_cycles}) {
    HoppedCycles hop(cycle, {}, {.seed = 4, .noise = true}, hang_cycles);
    std::int64_t armed = 0, released = 0;
    while (released == 0 && hop.next()) {
      const auto now = static_cast<std::int64_t>(hop.frame().cycle);
      for (const auto& event : hop.controller().events())
        if (event.kind == EventKind::armed) armed = now;
      if (hop.output().command.open_catch) released = now;
    }
    ASSERT_GT(armed, 0);
    EXPECT_EQ(released - armed, hang_cycles + 1);
  }
}

TEST(BedTrial, LandingsErrAsTheirPriorSays) {
  const double prior_m = ProfileConfig{}.landing_depth_sd_m;
  double squares_m2 = 0.0, landings = 0.0;
  for (std::uint64_t seed = 1; seed <= 30; ++seed)
    for (const auto& stride : trial_on("line", seed).strides)
      if (stride.landing_error_m) {
        squares_m2 += *stride.landing_error_m * *stride.landing_error_m;
        landings += 1.0;
      }
  ASSERT_GE(landings, 30.0);
  // Three standard errors of an rms of 30 values are 39 %.
  EXPECT_GT(std::sqrt(squares_m2 / landings), 0.61 * prior_m);
  EXPECT_LT(std::sqrt(squares_m2 / landings), 1.39 * prior_m);
}

TEST(BedTrial, EveryStrideOfACrustIsSearchedAndTheRuptureFoundOnce) {
  const auto trial = trial_on("crust", 12);
  ASSERT_GE(trial.strides.size(), 2U);
  for (const auto& stride : trial.strides) {
    ASSERT_TRUE(stride.events_complete);
    EXPECT_EQ(stride.events.stride, stride.sums.summary.stride);
    const auto found = find_ground_events(stride.events, {});
    EXPECT_EQ(found.rupture.kind == GroundEventKind::crust_rupture, stride.events.stride == 1);
    if (stride.events.stride != 1) continue;
    EXPECT_NEAR(found.rupture.depth_m, *trial.truth.rupture_depth_m, 0.002);
  }
}

// A rupture at a depth that is 1 mm off must not be taken for a boundary of layers.
TEST(BedTrial, CrustsHaveFewBoundaries) {
  int ruptures = 0, boundaries = 0;
  constexpr std::uint64_t kTrials = 100;
  for (std::uint64_t seed = 1; seed <= kTrials; ++seed) {
    const auto trial = run_bed_trial({}, {}, bed_named("crust"), seed, 2);
    if (trial.strides.empty() || !trial.strides[0].events_complete) continue;
    const auto found = find_ground_events(trial.strides[0].events, {});
    ruptures += found.rupture.kind == GroundEventKind::crust_rupture;
    boundaries += found.boundary.kind == GroundEventKind::layer_boundary;
  }
  EXPECT_GE(ruptures, 70);
  EXPECT_LE(boundaries, ruptures / 8);
}

// On heavy ground the force on a foot that breaks through is mostly inertia. The prior of the added mass
// explains it badly, the profile of the same stride well.
TEST(BedTrial, CrustsOnHeavyGroundAreFoundWithTheProfilesAddedMass) {
  WorldConfig heavy;
  heavy.terrain.added_mass_factor = 3.0;
  int broken = 0, with_prior = 0, with_profile = 0;
  for (std::uint64_t seed = 1; seed <= 120; ++seed) {
    const auto trial = run_bed_trial({}, heavy, bed_named("crust"), seed, 1);
    if (trial.strides.empty() || !trial.strides[0].events_complete) continue;
    const auto& stride = trial.strides[0];
    if (stride.true_deepest_m < *trial.truth.rupture_depth_m + 0.001) continue;
    ProfileSolver solver{StiffnessConfig{}};
    solver.add(stride.sums.profile, stride.sums.summary.stride);
    const auto finds = [&](const StrengthProfile& profile) {
      const auto found = find_ground_events(stride.events, {}, profile).rupture;
      return found.kind == GroundEventKind::crust_rupture &&
             std::abs(found.depth_m - *trial.truth.rupture_depth_m) < 0.010;
    };
    ++broken;
    with_prior += finds({});
    with_profile += finds(solver.profile());
  }
  ASSERT_GE(broken, 60);
  EXPECT_GT(with_profile, with_prior);
  EXPECT_GE(with_profile, 0.95 * broken);
}

TEST(BedTrial, StridesInTheCraterGiveItsReloadingLine) {
  const auto trial = trial_on("line", 11);
  ProfileSolver solver{StiffnessConfig{}};
  for (const auto& stride : trial.strides) {
    solver.add(stride.sums.profile, stride.sums.summary.stride);
    const auto k = summarise(solver).reloading_N_per_m;
    EXPECT_LT(k.ci95_low, trial.truth.unloading_stiffness_N_per_m);
    EXPECT_GT(k.ci95_high, trial.truth.unloading_stiffness_N_per_m);
    EXPECT_LT(k.ci95_high, 2.0 * k.ci95_low);
  }
  EXPECT_GE(trial.strides.size(), 2U);
}

// The accelerometer feels the blow before the motors reply. Half of the expected mean time leaves -0.1 ms,
// twice of it 0.25 ms.
TEST(BedScore, NothingRemainsOfTheMeanTimeAtContact) {
  const auto scores =
      score_beds({.cycle = {}, .world = {}, .beds = {"line"}, .ground = GroundDraw::centre, .trials = 300});
  ASSERT_EQ(scores.size(), 1u);
  EXPECT_NEAR(scores[0].contact_time.remaining_s(), 0.0, 0.00005);
}

// A ground's inertia differs from trial to trial, but not among the places of one session: strides of two
// grounds have no common drag.
TEST(BedScore, GroundIsDrawnForEachTrialAndForEachSession) {
  const BedScoreSetup setup{.beds = {"line"}, .trials = 8, .places = {4}};
  auto centre = setup;
  centre.ground = GroundDraw::centre;
  const auto drawn = score_beds(setup)[0], fixed = score_beds(centre)[0];
  EXPECT_GT(drawn.first.less_drag.depths, 0.0);
  EXPECT_EQ(drawn.first.less_drag.depths + drawn.first.more_drag.depths, drawn.first.band.depths);
  EXPECT_EQ(fixed.first.less_drag.depths + fixed.first.more_drag.depths, 0.0);
  EXPECT_NE(drawn.first.band.squared_error, fixed.first.band.squared_error);
  EXPECT_EQ(drawn.places[0].sessions, 2.0);
}

}  // namespace
}  // namespace sandhopper
