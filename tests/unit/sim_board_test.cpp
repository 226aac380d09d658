#include "tools/plant/sim_board.hpp"

#include <gtest/gtest.h>

namespace sandhopper {
namespace {

constexpr std::int64_t kCycle_ns = 1'000'000;

struct Bench {
  World world{WorldConfig{}, TrialSetup{.noise = false}, 10 * kCycle_ns};
  SimBoard board{world};
  SensorFrame frame{};

  const SensorFrame& read(int cycle) {
    frame.time_ns = (10 + cycle) * kCycle_ns;
    board.read(frame);
    return frame;
  }
};

TEST(SimBoard, ReadMovesTheWorldToTheFramesTime) {
  Bench bench;
  bench.read(7);
  EXPECT_EQ(bench.world.now_ns(), 17 * kCycle_ns);
}

TEST(SimBoard, MotorReplyIsTheStateAtTheWriteItAnswersAndComesOnce) {
  Bench bench;
  EXPECT_FALSE(bench.read(0).motor[0].fresh);
  bench.read(1);
  bench.board.write({.drive = DriveRequest::off});
  const auto& frame = bench.read(2);
  EXPECT_TRUE(frame.motor[0].fresh);
  EXPECT_TRUE(frame.motor[1].fresh);
  EXPECT_EQ(frame.motor[0].time_ns, 11 * kCycle_ns);
  EXPECT_NEAR(frame.motor[0].position_rad, bench.world.truth().leg_angle_rad, 1e-12);
  EXPECT_FALSE(bench.read(3).motor[0].fresh);  // no command was written since
  EXPECT_EQ(bench.frame.motor[0].time_ns, 11 * kCycle_ns);
}

TEST(SimBoard, OnlyRunMakesTorque) {
  for (const auto request : {DriveRequest::off, DriveRequest::enable, DriveRequest::run}) {
    Bench bench;
    Command command{.drive = request};
    for (auto& motor : command.motor) motor.torque_Nm = 0.5;
    for (int cycle = 0; cycle < 20; ++cycle) {
      bench.read(cycle);
      bench.board.write(command);
    }
    const double expected_A = request == DriveRequest::run ? 0.5 / 0.0868 : 0.0;
    EXPECT_NEAR(bench.read(20).motor[1].current_A, expected_A, 1e-6);
  }
}

TEST(SimBoard, CatchOpensOnRequestAndStaysOpen) {
  Bench bench;
  bench.read(0);
  bench.board.write({});
  bench.read(20);
  EXPECT_FALSE(bench.world.truth().released);
  bench.board.write({.open_catch = true});
  bench.read(21);
  bench.board.write({.open_catch = false});
  bench.read(60);
  EXPECT_TRUE(bench.world.truth().released);
  EXPECT_NEAR(bench.world.truth().foot_velocity_mps, -9.81 * 0.04, 0.1);
}

TEST(SimBoard, ASampleIsFreshInTheFirstCycleThatSeesItOnly) {
  Bench bench;
  int imu = 0, tof = 0, cell = 0;
  for (int cycle = 1; cycle <= 1000; ++cycle) {
    const auto before = bench.frame;
    const auto& frame = bench.read(cycle);
    EXPECT_EQ(frame.load_cell.fresh, frame.load_cell.time_ns != before.load_cell.time_ns);
    EXPECT_LE(frame.load_cell.time_ns, frame.time_ns);
    EXPECT_TRUE(!frame.tof.fresh || frame.time_ns - frame.tof.time_ns >= 2 * kCycle_ns);
    imu += frame.imu_body.fresh;
    tof += frame.tof.fresh;
    cell += frame.load_cell.fresh;
    EXPECT_FALSE(frame.emergency_stop);
  }
  EXPECT_EQ(imu, 1000);
  EXPECT_NEAR(tof, 500, 2);
  EXPECT_NEAR(cell, 860, 2);
  EXPECT_NEAR(bench.frame.imu_body.samples, 1666, 2);
}

}  // namespace
}  // namespace sandhopper
