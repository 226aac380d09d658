#include <gmock/gmock.h>

#include <random>

#include "tests/unit/calibration_bench.hpp"
#include "tools/calibrate/torque_constant.hpp"

namespace sandhopper::calibrate {
namespace {

constexpr double kLeft = 0.0741, kRight = 0.0812;

LinuxBoardConfig believed_board() {
  LinuxBoardConfig board;
  board.can.motor = RobotConfig{}.motor;
  return board;
}

std::vector<Recording> press(std::uint64_t seed, double peak_torque_Nm = 0.8, int repeats = 4) {
  RobotConfig real;
  real.motor[0].torque_constant_Nm_per_A = kLeft;
  real.motor[1].torque_constant_Nm_per_A = kRight;
  LinuxBoardConfig real_board;
  real_board.can.motor = real.motor;
  WorldConfig world;
  world.motor.torque_constant_Nm_per_A = kLeft;
  world.spread.torque_constant_relative = 0.0;  // only the planted errors act
  const PressProgram program{.peak_torque_Nm = peak_torque_Nm};
  Step step{.prompt = "", .fixture = {.clamped = true}, .seconds = program.duration_s()};
  step.torque_Nm = [program](double time_s) { return program.torque_Nm(time_s); };
  return record_on_sim(
      {}, {}, {.world = world, .real_robot = real, .real_board = real_board, .trial = {.seed = seed}},
      std::vector(static_cast<std::size_t>(repeats), step));
}

Outcome fit(const std::vector<Recording>& presses) {
  return calibrate_torque_constant(presses, believed_board(), Leg(LegParameters{}),
                                   {.load_cell_ci95_relative = 0.002});
}

TEST(CalibrateTorqueConstant, FindsBothConstantsDespiteFriction) {
  Coverage constants;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const auto outcome = fit(press(seed));
    ASSERT_EQ(reasons(outcome), "") << outcome.refusals.front().text;
    constants.see(value_of(outcome, "motor[0].torque_constant_Nm_per_A"), kLeft);
    constants.see(value_of(outcome, "motor[1].torque_constant_Nm_per_A"), kRight);
    EXPECT_LT(value_of(outcome, "motor[0].torque_constant_Nm_per_A").ci95, 0.02 * kLeft);
  }
  EXPECT_GE(constants.held, 16) << "of 20";
}

TEST(CalibrateTorqueConstant, TwoPressesAreTooFew) {
  EXPECT_EQ(reasons(fit(press(1, 0.8, 2))), "too_few_points");
}

TEST(CalibrateTorqueConstant, APressWithHardlyAnyForceIsRefused) {
  EXPECT_THAT(reasons(fit(press(1, 0.1))), ::testing::StartsWith("too_little_force"));
}

TEST(CalibrateTorqueConstant, ALegThatGivesWayIsRefused) {
  auto presses = press(1);
  for (std::size_t i = 4000; i < presses[2].motor[1].size(); ++i) presses[2].motor[1][i].position_rad += 0.05;
  EXPECT_EQ(reasons(fit(presses)), "moving");
}

TEST(CalibrateTorqueConstant, ACellAtItsEndIsRefused) {
  auto presses = press(1);
  presses[0].load_cell[3000].force_N = 409.59;
  EXPECT_EQ(reasons(fit(presses)), "saturated");
}

TEST(CalibrateTorqueConstant, AForceThatDoesNotFollowTheCurrentIsRefused) {
  auto presses = press(1);
  for (std::size_t i = 0; i < presses[1].load_cell.size(); ++i)
    presses[1].load_cell[i].force_N += 4.0 * std::sin(0.004 * static_cast<double>(i));
  EXPECT_THAT(reasons(fit(presses)), ::testing::HasSubstr("residual_too_large"));
}

TEST(CalibrateTorqueConstant, PressesThatDisagreeAreRefused) {
  auto presses = press(1);
  for (auto& sample : presses[3].load_cell) sample.force_N *= 1.1;
  EXPECT_EQ(reasons(fit(presses)), "interval_too_wide interval_too_wide");
}

TEST(CalibrateTorqueConstant, AMotorOfTheWrongSignIsNamed) {
  auto presses = press(1);
  for (auto& one : presses)
    for (auto& sample : one.motor[1]) sample.current_A = -sample.current_A;
  EXPECT_THAT(reasons(fit(presses)), ::testing::HasSubstr("wrong_sign"));
}

}  // namespace
}  // namespace sandhopper::calibrate
