#include <gmock/gmock.h>

#include "tests/unit/calibration_bench.hpp"
#include "tools/calibrate/encoders.hpp"
#include "tools/calibrate/velocity_range.hpp"

namespace sandhopper::calibrate {
namespace {

constexpr double kLength_m = 0.30;

struct Bench {
  std::uint64_t seed = 1;
  int repeats = 3;
  double shorten_rad = 0.4;
  double misplaced_m = 0.0;  // error of the known pose
  double swing_rad = 0.6;
  std::array<double, kMotorCount> velocity_range_radps{50.0, 50.0};  // the configured value is 50
};

RobotConfig real_robot() {
  RobotConfig robot;
  robot.motor[0].zero_offset_rad = 0.352;
  robot.motor[1].zero_offset_rad = -1.207;
  robot.motor[1].sign = -1;
  return robot;
}

EncoderRecordings record(const Bench& bench) {
  auto real = real_robot();
  for (std::size_t i = 0; i < kMotorCount; ++i)
    real.motor[i].velocity_range_radps = bench.velocity_range_radps[i];
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
  Step moved{.prompt = "", .fixture = {}, .seconds = 2.0};
  moved.fixture.leg_angle_rad = leg.angle_at_length(kLength_m);
  moved.fixture.leg_swing_rad = bench.swing_rad;
  for (int i = 0; i < bench.repeats; ++i) {
    moved.fixture.leg_swing_period_s = 0.8 + 0.2 * i;
    steps.push_back(moved);
  }
  const auto recordings = record_on_sim(
      {}, {}, {.world = {}, .real_robot = real, .real_board = real_board, .trial = {.seed = bench.seed}},
      steps);
  EncoderRecordings out;
  const auto poses = 2 * static_cast<std::size_t>(bench.repeats);
  for (std::size_t i = 0; i < poses; i += 2) out.pairs.push_back({recordings[i], recordings[i + 1]});
  out.moved.assign(recordings.begin() + static_cast<std::ptrdiff_t>(poses), recordings.end());
  return out;
}

Outcome fit(const EncoderRecordings& recordings, double accuracy_m = 0.0) {
  return calibrate_encoders(recordings, MotorConfigs(RobotConfig{}.motor), Leg(LegParameters{}),
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
  const auto recordings = record({});
  EXPECT_GT(value_of(fit(recordings, 0.001), "motor[0].zero_offset_rad").ci95,
            5.0 * value_of(fit(recordings), "motor[0].zero_offset_rad").ci95);
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
  auto recordings = record({});
  auto& pairs = recordings.pairs;
  std::swap(pairs[1].known, pairs[1].shortened);
  EXPECT_EQ(reasons(fit(recordings)), "repeats_disagree repeats_disagree");
}

TEST(CalibrateEncoders, SidesThatMoveDifferentlyAreRefused) {
  auto recordings = record({});
  auto& pairs = recordings.pairs;
  for (auto& sample : pairs[2].shortened.motor[1]) sample.position_rad += 0.08;
  EXPECT_EQ(reasons(fit(recordings)), "sides_disagree");
}

TEST(CalibrateEncoders, APoseThatMovesWhileItIsRecordedIsRefused) {
  auto recordings = record({});
  auto& pairs = recordings.pairs;
  auto& samples = pairs[1].known.motor[0];
  for (std::size_t i = 0; i < samples.size(); ++i)
    samples[i].position_rad += 0.02 * std::sin(0.02 * static_cast<double>(i));
  EXPECT_EQ(reasons(fit(recordings)), "moving");
}

TEST(CalibrateEncoders, ADriveAtTheEndOfItsPositionIsRefused) {
  auto recordings = record({});
  auto& pairs = recordings.pairs;
  for (auto& sample : pairs[0].known.motor[0]) sample.position_rad = 12.5;
  EXPECT_THAT(reasons(fit(recordings)), ::testing::HasSubstr("saturated"));
}

std::vector<SpeedRatio> speeds(const EncoderRecordings& recordings, std::string& refused) {
  std::vector<SpeedRatio> out;
  std::vector<Refusal> refusals;
  const RobotConfig believed;
  for (std::size_t i = 0; i < kMotorCount; ++i)
    out.push_back(check_velocity_range(recordings.moved, i, believed.motor[i], refusals));
  for (const auto& refusal : refusals)
    refused += refusal.reason + ": " + refusal.text + ": " + refusal.cure + "; ";
  return out;
}

TEST(CalibrateVelocityRange, OfADriveThatIsWhatItIsBelievedToBeHoldsOne) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    std::string refused;
    for (const auto& speed : speeds(record({.seed = seed}), refused)) {
      EXPECT_NEAR(speed.value, 1.0, 0.005) << seed;
      EXPECT_LT(speed.ci95, 0.025) << seed;
    }
    EXPECT_EQ(refused, "") << seed;
  }
}

// The ratio is the configured range divided by the true one.
TEST(CalibrateVelocityRange, ThatIsWrongIsFoundAndSaidWithTheLikelyOne) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed)
    for (const double real : {25.0, 37.5, 45.0, 60.0, 100.0}) {
      std::string refused;
      const auto found = speeds(record({.seed = seed, .velocity_range_radps = {real, 50.0}}), refused);
      EXPECT_NEAR(found[0].value, 50.0 / real, found[0].ci95) << "range " << real << ", seed " << seed;
      EXPECT_NEAR(found[1].value, 1.0, 0.005);
      EXPECT_THAT(refused, ::testing::StartsWith("velocity_range_wrong: motor left reports ")) << real;
      EXPECT_THAT(refused, ::testing::HasSubstr("velocity_range_radps is 50, the drive's is likely "));
      if (seed == 1) std::printf("  range %5.1f: %s\n", real, refused.c_str());
    }
}

TEST(CalibrateVelocityRange, ThatIsWrongLeavesZeroAndSignUnwritten) {
  const auto outcome = fit(record({.velocity_range_radps = {25.0, 25.0}}));
  EXPECT_EQ(reasons(outcome), "velocity_range_wrong velocity_range_wrong");
}

TEST(CalibrateVelocityRange, OfAnotherDialectIsSaidByItsPolePairs) {
  auto recordings = record({});
  for (auto& recording : recordings.moved)
    for (auto& sample : recording.motor[0]) sample.velocity_radps *= 2.0;
  auto motor = RobotConfig{}.motor[0];
  motor.dialect = Dialect::servo;
  std::vector<Refusal> refusals;
  check_velocity_range(recordings.moved, 0, motor, refusals);
  ASSERT_EQ(refusals.size(), 1U);
  const std::string said = "pole_pairs times drive_reduction is 21, of this motor it is likely ";
  ASSERT_THAT(refusals[0].cure, ::testing::StartsWith(said));
  EXPECT_NEAR(std::stod(refusals[0].cure.substr(said.size())), 42.0, 0.02 * 42.0);
}

TEST(CalibrateVelocityRange, CannotBeSeenOnALegAtRest) {
  EXPECT_EQ(reasons(fit(record({.swing_rad = 0.0}))), "moved_too_little moved_too_little");
}

TEST(CalibrateVelocityRange, RecordingsThatDisagreeSayNothing) {
  auto recordings = record({});
  for (auto& sample : recordings.moved[1].motor[1]) sample.velocity_radps *= 1.3;
  EXPECT_EQ(reasons(fit(recordings)), "interval_too_wide");
}

}  // namespace
}  // namespace sandhopper::calibrate
