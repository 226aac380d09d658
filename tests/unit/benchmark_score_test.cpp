#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tools/benchmark/baselines.hpp"
#include "tools/benchmark/figures.hpp"

namespace sandhopper::benchmark {
namespace {

Truth hidden(std::string kind, std::vector<std::string> ids, double size = 1.0) {
  Truth t;
  t.name = "001";
  t.plant = "hopper";
  t.kind = std::move(kind);
  for (auto& id : ids) t.effects.push_back({std::move(id), size, {}});
  return t;
}

Diagnosis saying(std::string verdict, std::vector<Claim> claims) {
  Diagnosis d;
  d.verdict = std::move(verdict);
  d.claims = std::move(claims);
  return d;
}

Claim named(std::string id, double probability, std::vector<std::string> alike = {}) {
  return {std::move(id), probability, std::move(alike), {}};
}

TEST(BenchmarkInterval, AgreesWithTables) {
  EXPECT_NEAR(wilson95(0, 20).high, 0.1611, 1e-4);
  EXPECT_NEAR(wilson95(10, 10).low, 0.7225, 1e-4);
  EXPECT_NEAR(clopper_pearson95(0, 20).high, 0.1684, 1e-4);
  EXPECT_NEAR(clopper_pearson95(5, 10).low, 0.1871, 1e-4);
  EXPECT_NEAR(clopper_pearson95(5, 10).high, 0.8129, 1e-4);
  EXPECT_EQ(clopper_pearson95(0, 0).high, 1.0);
}

TEST(BenchmarkJudge, ConsistentIsRightOnlyWhereNothingIsHidden) {
  const auto nothing = hidden("null", {}), something = hidden("single", {"rail.coulomb"});
  EXPECT_FALSE(judge(nothing, null_only()).alarm);
  EXPECT_FALSE(judge(something, null_only()).right);
}

TEST(BenchmarkJudge, AnyAlarmOnNothingIsFalse) {
  const auto nothing = hidden("null", {});
  EXPECT_TRUE(judge(nothing, saying("unknown_physics", {named("unknown@rail", 0.3)})).alarm);
  EXPECT_FALSE(judge(nothing, saying("unknown_physics", {named("unknown@rail", 0.9)})).confident_wrong);
  EXPECT_TRUE(judge(nothing, saying("missing_physics", {named("rail.coulomb", 0.8)})).confident_wrong);
}

TEST(BenchmarkJudge, ClassThatHoldsTheTruthIsRightAndCountsItsSize) {
  const auto truth = hidden("single", {"rail.coulomb"});
  const auto j =
      judge(truth, saying("missing_physics", {named("rail.viscous", 0.9, {"rail.coulomb", "rail.tilt"})}));
  EXPECT_TRUE(j.right);
  EXPECT_EQ(j.class_size, 3u);
  EXPECT_FALSE(j.confident_wrong);
  EXPECT_TRUE(judge(truth, saying("missing_physics", {named("rail.viscous", 0.9)})).confident_wrong);
}

TEST(BenchmarkJudge, ExactSetAllowsNothingMissingAndNothingMore) {
  const auto truth = hidden("several", {"rail.coulomb", "tof.bias"});
  EXPECT_TRUE(
      judge(truth, saying("missing_physics", {named("tof.bias", 0.9), named("rail.coulomb", 0.7)})).exact);
  const auto half = judge(truth, saying("missing_physics", {named("tof.bias", 0.9)}));
  EXPECT_TRUE(half.right);
  EXPECT_FALSE(half.exact);
  EXPECT_FALSE(passed(half));
  EXPECT_FALSE(judge(truth, saying("missing_physics", {named("tof.bias", 0.9), named("rail.coulomb", 0.7),
                                                       named("imu.bias", 0.1)}))
                   .exact);
  // A class must not count for two hidden effects.
  EXPECT_FALSE(judge(truth, saying("missing_physics", {named("tof.bias", 0.9, {"rail.coulomb"})})).exact);
}

TEST(BenchmarkJudge, DragBesideAddedMassIsNoMistake) {
  const auto truth = hidden("single", {"terrain.added_mass"});
  const auto j = judge(truth, saying("missing_physics", {named("terrain.added_mass", 0.95),
                                                         named("terrain.quadratic_drag", 0.9)}));
  EXPECT_TRUE(j.right);
  EXPECT_TRUE(j.exact);
  EXPECT_FALSE(j.confident_wrong);
}

TEST(BenchmarkJudge, UnknownMustBeAtItsPort) {
  auto truth = hidden("unknown", {"burr_on_the_rail"});
  truth.unknown_port = "rail";
  EXPECT_TRUE(judge(truth, saying("unknown_physics", {named("unknown@rail", 0.9)})).unknown_at_port);
  EXPECT_FALSE(judge(truth, saying("unknown_physics", {named("unknown@ground", 0.9)})).unknown_at_port);
  EXPECT_TRUE(judge(truth, saying("missing_physics", {named("rail.coulomb", 0.9)})).confident_wrong);
}

TEST(BenchmarkJudge, NoAnswerIsNeverRight) {
  const auto nothing = hidden("null", {});
  const auto j = judge(nothing, std::nullopt);
  EXPECT_FALSE(j.answered);
  EXPECT_FALSE(j.alarm);
  EXPECT_FALSE(j.right);
  EXPECT_FALSE(passed(j));
}

TEST(BenchmarkJudge, IntervalsAreComparedByNameElseByUnit) {
  auto truth = hidden("single", {"rail.coulomb"});
  truth.effects[0].parameters = {{"coulomb_N", 1.5}, {"speed_mps", 0.1}};
  auto claim = named("rail.coulomb", 0.9);
  claim.parameters = {{"friction_N", {1.4, 1.3, 1.6, true}}, {"width_m", {0.1, 0.0, 0.2, true}}};
  const auto j = judge(truth, saying("missing_physics", {claim}));
  EXPECT_EQ(j.intervals, 1u);
  EXPECT_EQ(j.intervals_hold, 1u);
  EXPECT_EQ(j.intervals_without_counterpart, 1u);
}

TEST(BenchmarkJudge, AHiddenSizeAboveItsUpperBoundBreaksTheBound) {
  auto truth = hidden("several", {"rail.coulomb", "rail.viscous"});
  truth.effects[0].parameters = {{"friction_N", -1.5}};
  truth.effects[1].parameters = {{"viscous_N_s_per_m", 0.3}};
  auto answer = null_only();
  answer.absent = {{"rail.coulomb", "friction_N", 1.4}, {"rail.viscous", "viscous_N_s_per_m", 0.4}};
  const auto j = judge(truth, answer);
  EXPECT_EQ(j.bounded, 2u);
  EXPECT_EQ(j.bounds_hold, 1u);
  EXPECT_FALSE(score({j}).figures.back().met());
}

// A sensor's effect is bounded by its channel, a change by the number it changes, a stiffness from below.
TEST(BenchmarkScore, BoundsAreOfTheHiddenChannelAndOfAChangeAndFromBelow) {
  auto truth = hidden("single", {"clock.skew"}, 0.5);
  truth.effects[0].channel = "force_N";
  truth.effects[0].parameters = {{"skew_s", 0.003}};
  EXPECT_FALSE((UpperBound{"clock.skew[foot_z_m]", "skew_s", 0.001}).size_of(truth.effects[0]));
  EXPECT_EQ((UpperBound{"clock.skew[force_N]", "skew_s", 0.001}).size_of(truth.effects[0]), 0.003);
  truth = hidden("single", {"axis.coulomb"}, 0.5);
  truth.effects[0].parameters = {{"coulomb_friction_change_Nm", -0.02}};
  EXPECT_EQ((UpperBound{"axis.coulomb", "coulomb_friction_Nm", 0.03}).size_of(truth.effects[0]), 0.02);
  // A new number is no change: the answer does not hold what was believed.
  truth.effects[0].parameters = {{"coulomb_friction_Nm", 0.05}};
  EXPECT_FALSE((UpperBound{"axis.coulomb", "coulomb_friction_change_Nm", 0.03}).size_of(truth.effects[0]));
  const UpperBound stiffness{"rig.compliance", "stiffness_N_per_m", 5e4, true};
  EXPECT_TRUE(stiffness.holds(6e4));
  EXPECT_FALSE(stiffness.holds(4e4));
}

TEST(BenchmarkScore, CountsFiguresCalibrationAndLadder) {
  const auto nothing = hidden("null", {}), one = hidden("single", {"rail.coulomb"}, 1.0),
             small = hidden("single", {"rail.coulomb"}, 0.2);
  const auto s =
      score({judge(nothing, saying("missing_physics", {named("tof.bias", 0.6)})), judge(nothing, null_only()),
             judge(one, saying("missing_physics", {named("rail.coulomb", 0.8)})), judge(small, null_only())});
  EXPECT_EQ(s.figures[0].count, 1u);
  EXPECT_EQ(s.figures[0].of, 2u);
  EXPECT_FALSE(s.figures[0].met());
  EXPECT_EQ(s.figures[1].count, 1u);
  EXPECT_EQ(s.figures[1].of, 1u);  // the small one does not count, because it is below the typical size
  EXPECT_NEAR(s.expected_calibration_error, (0.6 + 0.2) / 2.0, 1e-12);
  EXPECT_EQ(s.ladder[0].cases, 1u);
  EXPECT_EQ(s.ladder[0].right, 0u);
  EXPECT_EQ(s.by_effect.at("rail.coulomb").right_alone, 1u);
  EXPECT_EQ(s.by_effect.at("rail.coulomb").nothing, 1u);
}

TEST(BenchmarkBaselines, RandomPickIsTheSameForTheSameCampaign) {
  const auto truth = hidden("single", {"rail.coulomb"});
  const std::vector<std::string> ids{"a.b", "c.d", "e.f"};
  EXPECT_EQ(random_pick(truth, ids).claims[0].id, random_pick(truth, ids).claims[0].id);
  EXPECT_THAT(ids, testing::Contains(random_pick(truth, ids).claims[0].id));
}

}  // namespace
}  // namespace sandhopper::benchmark
