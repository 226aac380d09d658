#include <gmock/gmock.h>

#include "tests/unit/calibration_bench.hpp"
#include "tools/calibrate/encoders.hpp"

namespace sandhopper::calibrate {
namespace {

constexpr double kLength_m = 0.30;

struct Bench {
  std::uint64_t seed = 1;
  int repeats = 3;
  double shorten_rad = 0.4;
  double misplaced_m = 0.0;  // the known pose is not quite what it ought to be
};

RobotConfig real_robot() {
  RobotConfig robot;
  robot.motor[0].zero_offset_rad = 0.352;
  robot.motor[1].zero_offset_rad = -1.207;
  robot.motor[1].sign = -1;
  return robot;
}

std::vector<PosePair> record(const Bench& bench) {
  const auto real = real_robot();
  LinuxBoardConfig real_board;
  real_board.can.motor = real.motor;
  const Leg leg(real.robot);
  std::vector<Step> steps;
  for (int i = 0; i < bench.repeats; ++i) {
    Step known{.prompt = "", .fixture = {}, .seconds = 1.0}, shortened = known;
    known.fixture.leg_angle_rad = leg.angle_at_length(kLength_m + bench.misplaced_m * (i - 1));
    shortened.fixture.leg_angle_rad = *known.fixture.leg_angle_rad + bench.shorten_rad;
    steps.push_back(known);
    steps.push_back(shortened);
  }
  const auto recordings = record_on_sim(
      {}, {}, {.world = {}, .real_robot = real, .real_board = real_board, .trial = {.seed = bench.seed}},
      steps);
  std::vector<PosePair> pairs;
  for (std::size_t i = 0; i < recordings.size(); i += 2) pairs.push_back({recordings[i], recordings[i + 1]});
  return pairs;
}

Outcome fit(const std::vector<PosePair>& pairs, double accuracy_m = 0.0) {
  return calibrate_encoders(pairs, MotorConfigs(RobotConfig{}.motor), Leg(LegParameters{}),
                            {.known_length_m = kLength_m, .length_accuracy_m = accuracy_m});
}

TEST(CalibrateEncoders, FindsZeroAndSignOfBothSides) {
  Coverage zero;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const auto outcome = fit(record({.seed = seed}));
    ASSERT_EQ(reasons(outcome), "") << outcome.refusals.front().text;
    EXPECT_EQ(value_of(outcome, "motor[0].sign").after, 1.0);
    EXPECT_EQ(value_of(outcome, "motor[1].sign").after, -1.0);
    zero.see(value_of(outcome, "motor[0].zero_offset_rad"), 0.352);
    zero.see(value_of(outcome, "motor[1].zero_offset_rad"), -1.207);
    EXPECT_LT(value_of(outcome, "motor[0].zero_offset_rad").ci95, 0.001);
  }
  EXPECT_GE(zero.held, 13) << "of 16";
}

TEST(CalibrateEncoders, APoseThatIsNotAlwaysTheSameWidensTheInterval) {
  const auto outcome = fit(record({.misplaced_m = 0.0005}));
  ASSERT_EQ(reasons(outcome), "");
  const auto& zero = value_of(outcome, "motor[0].zero_offset_rad");
  EXPECT_NEAR(zero.after, 0.352, zero.ci95);
  EXPECT_GT(zero.ci95, 0.005);
}

TEST(CalibrateEncoders, ALengthThatIsNotWellKnownWidensTheInterval) {
  const auto pairs = record({});
  EXPECT_GT(value_of(fit(pairs, 0.001), "motor[0].zero_offset_rad").ci95,
            5.0 * value_of(fit(pairs), "motor[0].zero_offset_rad").ci95);
}

TEST(CalibrateEncoders, APoseThatVariesTooMuchIsRefused) {
  EXPECT_EQ(reasons(fit(record({.misplaced_m = 0.004}))), "interval_too_wide interval_too_wide");
}

TEST(CalibrateEncoders, TwoPairsAreTooFew) {
  EXPECT_EQ(reasons(fit(record({.repeats = 2}))), "too_few_points");
}

TEST(CalibrateEncoders, ALegThatWasHardlyShortenedIsRefused) {
  EXPECT_EQ(reasons(fit(record({.shorten_rad = 0.03}))), "moved_too_little moved_too_little");
}

TEST(CalibrateEncoders, ALegThatWasOnceShortenedAndOnceLengthenedIsRefused) {
  auto pairs = record({});
  std::swap(pairs[1].known, pairs[1].shortened);
  EXPECT_EQ(reasons(fit(pairs)), "repeats_disagree repeats_disagree");
}

TEST(CalibrateEncoders, SidesThatMoveDifferentlyAreRefused) {
  auto pairs = record({});
  for (auto& sample : pairs[2].shortened.motor[1]) sample.position_rad += 0.08;
  EXPECT_EQ(reasons(fit(pairs)), "sides_disagree");
}

TEST(CalibrateEncoders, APoseThatMovesWhileItIsRecordedIsRefused) {
  auto pairs = record({});
  auto& samples = pairs[1].known.motor[0];
  for (std::size_t i = 0; i < samples.size(); ++i)
    samples[i].position_rad += 0.02 * std::sin(0.02 * static_cast<double>(i));
  EXPECT_EQ(reasons(fit(pairs)), "moving");
}

TEST(CalibrateEncoders, ADriveAtTheEndOfItsPositionIsRefused) {
  auto pairs = record({});
  for (auto& sample : pairs[0].known.motor[0]) sample.position_rad = 12.5;
  EXPECT_THAT(reasons(fit(pairs)), ::testing::HasSubstr("saturated"));
}

}  // namespace
}  // namespace sandhopper::calibrate
