#include <gtest/gtest.h>

#include "config/files.hpp"
#include "tests/transmit_guard/guard_bench.hpp"

// The reaction to the first fault is over and the drives are off. A harsher second fault must not switch them
// on again for its own reaction.
namespace sandhopper::faults {
namespace {

TEST(SecondFault, DoesNotSwitchDrivesOnAgainThatTheFirstSwitchedOff) {
  auto robot = load_robot(std::filesystem::path(SANDHOPPER_SOURCE_DIR) / "config");
  robot.supervision.foot_height_m = 0.03;  // raises a fault with the reaction hold at arming
  robot.limits.fault_hold_s = robot.limits.fault_damp_s = 0.1;
  GuardBench bench(robot, 1);
  std::uint64_t off_at = 0;
  bool second = false;
  while (bench.cycles() < 3000 && !second) {
    const auto& output = bench.turn(bench.cycles() == 300 ? Request::arm : Request::none);
    const bool off = output.state == State::fault && output.command.drive == DriveRequest::off;
    if (off && off_at == 0) off_at = bench.cycles();
    if (off_at != 0 && bench.cycles() == off_at + 100) bench.board().set(Device::motor_left, Kind::hot);
    second = output.fault == Fault::motor_temperature;
  }
  ASSERT_TRUE(second);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(bench.turn().command.drive, DriveRequest::off) << i;
  EXPECT_EQ(bench.refused().count, 0U);
}

}  // namespace
}  // namespace sandhopper::faults
