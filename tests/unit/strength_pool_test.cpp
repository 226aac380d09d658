#include "tools/terrain/strength_pool.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tools/terrain/profile_text.hpp"

namespace sandhopper {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

// A slow press of a plate: F = k z^n with z in units of 20 mm, and sensor noise.
StrengthCurve press(double stiffness_N_per_m, double deepest_m, unsigned seed, double exponent = 1.0,
                    double diameter_m = 0.08) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(0.0, 0.3);
  std::vector<double> depth_m, force_N;
  for (int i = 1; i <= 300; ++i) {
    const double z = deepest_m * i / 300;
    depth_m.push_back(z);
    force_N.push_back(stiffness_N_per_m * 0.02 * std::pow(z / 0.02, exponent) + noise(random));
  }
  auto curve =
      curve_of_press(depth_m, force_N, {.diameter_m = diameter_m, .believed_stiffness_N_per_m = 1500.0});
  curve.trial = "trial " + std::to_string(seed);
  return curve;
}

std::vector<StrengthCurve> presses(std::size_t count, double spread) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  std::vector<StrengthCurve> curves;
  for (std::size_t i = 0; i < count; ++i)
    curves.push_back(press(1500.0 * (1.0 + spread * normal(random)), 0.04, static_cast<unsigned>(i + 1)));
  return curves;
}

TEST(StrengthCurve, OfAPressHoldsItsForceAndItsSlope) {
  const auto curve = press(2000.0, 0.04, 1);
  for (const double z : {0.005, 0.010, 0.020, 0.035}) {
    const auto force = curve.force_at(z);
    EXPECT_NEAR(force.value, 2000.0 * z, 2.5 * force.sd) << z;
    EXPECT_LT(force.sd, 0.05 * 2000.0 * z + 1.5) << z;
  }
  EXPECT_NEAR(curve.tangent_at(0.025).value, 2000.0, 3.0 * curve.tangent_at(0.025).sd);
  EXPECT_NEAR(curve.exponent.value, 1.0, 0.1);
  EXPECT_EQ(curve.shape, GroundShape::line);
  EXPECT_TRUE(std::isnan(curve.force_at(0.041).value));
}

TEST(StrengthCurve, DeeperThanTheCellsReachIsTheSameCurveInLargerCells) {
  std::vector<double> depth_m, force_N;
  for (int i = 1; i <= 400; ++i) {
    depth_m.push_back(0.001 * i);
    force_N.push_back(2000.0 * 0.001 * i);
  }
  const auto curve = curve_of_press(depth_m, force_N, {.diameter_m = 0.08});
  EXPECT_NEAR(curve.cell_m, 8.0 * kProfileCell_m, 1e-12);
  EXPECT_NEAR(curve.to_m, 0.4, 1e-9);
  for (const double z : {0.05, 0.2, 0.39})
    EXPECT_NEAR(curve.force_at(z).value, 2000.0 * z, 0.02 * 2000.0 * z);
  EXPECT_NEAR(curve.tangent_at(0.2).value, 2000.0, 100.0);
}

TEST(StrengthCurve, SurvivesTheResultOfItsTrial) {
  const auto curve = press(1500.0, 0.03, 2);
  TrialResult result;
  result.trial = curve.trial;
  keep_curve(curve, result);
  const auto back = curves_of(result);
  ASSERT_EQ(back.size(), 1u);
  EXPECT_EQ(back[0].force_N, curve.force_N);
  EXPECT_EQ(back[0].shape, curve.shape);
  EXPECT_EQ(back[0].exponent.value, curve.exponent.value);
  keep_curve({.source = CurveSource::drop}, result);  // has no points, so nothing is kept
  EXPECT_EQ(curves_of(result).size(), 1u);
}

TEST(StrengthPool, BandsHoldTheMeanAndTheNewTrialIsWider) {
  const auto groups = pool_curves(presses(8, 0.1));
  ASSERT_EQ(groups.size(), 1u);
  const auto& group = groups[0];
  const auto* point = group.at(0.020);
  ASSERT_NE(point, nullptr);
  EXPECT_EQ(point->force_N.trials, 8u);
  EXPECT_LT(point->force_N.mean_low, 30.0);
  EXPECT_GT(point->force_N.mean_high, 30.0);
  EXPECT_GT(point->force_N.new_high - point->force_N.new_low,
            2.0 * (point->force_N.mean_high - point->force_N.mean_low));
  EXPECT_NEAR(point->force_N.between_sd, 3.0, 2.0);
  EXPECT_NEAR(group.slope_N_per_m.value, 1500.0, 150.0);
  EXPECT_NEAR(group.exponent.value, 1.0, 0.05);
  EXPECT_EQ(group.left_out.size(), 8u);
  std::size_t inside = 0, depths = 0;
  for (const auto& trial : group.left_out) {
    inside += trial.inside;
    depths += trial.depths;
  }
  EXPECT_GT(static_cast<double>(inside) / static_cast<double>(depths), 0.8);
}

TEST(StrengthPool, ATrialThatTheOthersDoNotForetellIsOutsideTheirBand) {
  auto curves = presses(6, 0.03);
  curves.push_back(press(4500.0, 0.04, 99));
  const auto group = pool_curves(curves).front();
  EXPECT_LT(group.left_out.back().share(), 0.2);
  EXPECT_GT(group.left_out.back().force_ratio, 2.5);
}

TEST(StrengthPool, OneTrialHasNoBandAndPlatesOfTwoSizesAreTwoGroups) {
  const std::vector<StrengthCurve> curves{press(1500.0, 0.03, 1), press(1500.0, 0.03, 2, 1.0, 0.06)};
  const auto groups = pool_curves(curves);
  ASSERT_EQ(groups.size(), 2u);
  EXPECT_TRUE(std::isinf(groups[0].at(0.02)->force_N.mean_high));
  EXPECT_THAT(profile_answer(groups[0]), HasSubstr("one trial: others may differ"));
}

TEST(StrengthPool, DepthsThatOnlySomeTrialsReachedCountThoseTrials) {
  auto curves = presses(4, 0.05);
  curves.push_back(press(1500.0, 0.02, 50));
  const auto group = pool_curves(curves).front();
  EXPECT_EQ(group.at(0.015)->force_N.trials, 5u);
  EXPECT_EQ(group.at(0.035)->force_N.trials, 4u);
  EXPECT_NEAR(group.slope_to_m, 0.02, 1e-9);
}

TEST(StrengthPool, GroundOnWhichNoDepthIsSeenIsRigidAtLeastSoMuch) {
  std::vector<StrengthCurve> curves;
  for (int i = 0; i < 4; ++i)
    curves.push_back({.diameter_m = 0.08, .to_m = 2e-4, .greatest_N = 100.0 + i, .depth_sd_m = 7e-4});
  const auto group = pool_curves(curves).front();
  EXPECT_TRUE(group.depths.empty());
  const double bound = 101.5 / (2e-4 + 1.959964 * 7e-4);
  EXPECT_LT(group.at_least_N_per_m, bound);
  EXPECT_GT(group.at_least_N_per_m, 0.95 * bound);
  EXPECT_THAT(profile_answer(group), StartsWith("The ground is rigid: at least 63"));
  for (auto& curve : curves) curve.greatest_N = 4.0;  // a light touch gives no information
  EXPECT_THAT(profile_answer(pool_curves(curves).front()), StartsWith("The ground is not shown to be rigid"));
}

// Prediction by the area law: right for the first held-out plate, wrong by a factor of 2 for the second.
TEST(ProfilePrediction, CarriesTheBandOverToAnotherPlateByItsArea) {
  auto curves = presses(5, 0.05);
  const double area = (0.1 * 0.1) / (0.08 * 0.08);
  auto right = press(1500.0 * area, 0.04, 60, 1.0, 0.10), wrong = press(3000.0 * area, 0.04, 61, 1.0, 0.10);
  right.held_out = wrong.held_out = true;
  curves.push_back(right);
  curves.push_back(wrong);
  const auto told = conclude_profile(curves, {});
  ASSERT_EQ(told.predictions.size(), 1u);
  ASSERT_EQ(told.predictions[0].trials.size(), 2u);
  EXPECT_GT(told.predictions[0].trials[0].share(), 0.9);
  EXPECT_LT(told.predictions[0].trials[1].share(), 0.1);
  EXPECT_NEAR(told.predictions[0].trials[1].force_ratio, 2.0, 0.2);
  EXPECT_EQ(told.groups.size(), 1u);
}

TEST(ProfileText, TableHasARowForEveryDepthWithUnitsInItsHead) {
  const auto told = conclude_profile(presses(3, 0.05), {});
  const auto csv = profile_csv(told);
  EXPECT_THAT(csv, StartsWith("source,foot_diameter_m,depth_m,trials,force_N,force_mean_low_N,"));
  EXPECT_EQ(static_cast<std::size_t>(std::count(csv.begin(), csv.end(), '\n')),
            1 + told.groups[0].depths.size());
  const auto lines = profile_lines(told);
  EXPECT_THAT(lines.front(), HasSubstr("plate of 80 mm, 3 trials"));
  for (const auto& line : lines) EXPECT_LE(line.size(), 260u) << line;
  const auto json = profile_json(told);
  EXPECT_EQ(json["groups"][0]["trials"], 3);
  EXPECT_EQ(json["groups"][0]["depths"].size(), told.groups[0].depths.size());
}

}  // namespace
}  // namespace sandhopper
