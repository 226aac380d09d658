#include "firmware/linux_board.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/can/error.h>

#include <atomic>
#include <cmath>
#include <ctime>
#include <thread>

#include "config/files.hpp"
#include "drivers/can/can_socket.hpp"
#include "drivers/can/cubemars_drives.hpp"
#include "drivers/clock.hpp"
#include "drivers/device_error.hpp"
#include "drivers/imu/imu_reader.hpp"
#include "tests/unit/allocation_guard.hpp"
#include "tools/virtual_bench/control_client.hpp"

// Tests of the Linux board on the emulated devices. Run them inside tools/bench.
namespace sandhopper {
namespace {

constexpr std::int64_t kCycle_ns = 1'000'000;

const std::filesystem::path kConfig = std::filesystem::path(SANDHOPPER_SOURCE_DIR) / "config";

RobotConfig robot() { return load_robot(kConfig); }
LinuxBoardConfig board_config() { return load_linux_board(kConfig / "bench.toml", robot()); }

// The cycle around a board: read, a callback with the frame, write.
class Cycle {
 public:
  explicit Cycle(Board& board) : board_(board), next_ns_(monotonic_ns()) {}

  template <class OnFrame>
  void run(int cycles, const Command& command, OnFrame&& on_frame) {
    for (int i = 0; i < cycles; ++i) {
      next_ns_ += kCycle_ns;
      const timespec until{next_ns_ / kNanosecondsPerSecond, next_ns_ % kNanosecondsPerSecond};
      ::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
      frame_.time_ns = next_ns_;
      board_.read(frame_);
      on_frame(frame_);
      board_.write(command);
    }
  }
  void run(int cycles, const Command& command = {}) {
    run(cycles, command, [](const SensorFrame&) {});
  }

  const SensorFrame& frame() const { return frame_; }

 private:
  Board& board_;
  std::int64_t next_ns_;
  SensorFrame frame_{};
};

// Counts fresh samples of one sensor and checks that none is from the future, too old or out of order. The
// cycle wakes some microseconds after its start time, so a sample may be newer than the frame's time by that
// much.
struct Watched {
  double most_age_ms;
  int fresh = 0;
  std::int64_t last_ns = 0;

  template <class Sample>
  void see(const Sample& sample, std::int64_t now_ns) {
    if (!sample.fresh) return;
    ++fresh;
    EXPECT_GT(sample.time_ns, last_ns);
    EXPECT_LE(sample.time_ns, monotonic_ns());
    EXPECT_LE(static_cast<double>(now_ns - sample.time_ns) * 1e-6, most_age_ms);
    last_ns = sample.time_ns;
  }
};

Command request(DriveRequest drive, double torque_Nm = 0.0) {
  Command command;
  command.drive = drive;
  for (auto& motor : command.motor) motor.torque_Nm = torque_Nm;
  return command;
}

TEST(LinuxBoardOnBench, EverySensorDeliversAtItsOwnRateAndAge) {
  LinuxBoard board(board_config());
  Cycle cycle(board);
  cycle.run(50);
  const auto first = cycle.frame();
  Watched body{1.2}, foot{1.2}, load_cell{2.5}, tof{5.0};
  int without_load_cell = 0;
  cycle.run(2000, {}, [&](const SensorFrame& frame) {
    body.see(frame.imu_body, frame.time_ns);
    foot.see(frame.imu_foot, frame.time_ns);
    load_cell.see(frame.load_cell, frame.time_ns);
    tof.see(frame.tof, frame.time_ns);
    without_load_cell += !frame.load_cell.fresh;
    ASSERT_FALSE(frame.emergency_stop);
  });
  const auto& last = cycle.frame();
  const auto rate = [&](std::uint32_t from, std::uint32_t to) { return (to - from) / 2.0; };
  EXPECT_NEAR(rate(first.imu_body.samples, last.imu_body.samples), 1666.0, 0.04 * 1666);
  EXPECT_NEAR(rate(first.imu_foot.samples, last.imu_foot.samples), 1666.0, 0.04 * 1666);
  EXPECT_NEAR(rate(first.load_cell.samples, last.load_cell.samples), 860.0, 0.12 * 860);
  EXPECT_NEAR(tof.fresh / 2.0, 500.0, 0.05 * 500);
  EXPECT_EQ(body.fresh, 2000);
  EXPECT_GT(without_load_cell, 100);
  EXPECT_NEAR(last.imu_body.accel_mps2[2], 9.81, 1.0) << "held: one g up";
  EXPECT_GT(last.tof.height_m, 0.1);
  EXPECT_EQ(last.bus.send_failures + last.bus.receive_overflows + last.bus.errors, 0U);
  const auto status = board.status();
  for (const auto* bus : {&status.imu_body, &status.imu_foot, &status.load_cell, &status.tof}) {
    EXPECT_EQ(bus->failed_transfers, 0U);
    EXPECT_EQ(bus->missed_edges, 0U);
    EXPECT_EQ(bus->invalid, 0U);
  }
  std::printf("in 2 s: body IMU %u samples, foot IMU %u, load cell %u (%d cycles without), ToF %d\n",
              last.imu_body.samples - first.imu_body.samples, last.imu_foot.samples - first.imu_foot.samples,
              last.load_cell.samples - first.load_cell.samples, without_load_cell, tof.fresh);
}

TEST(LinuxBoardOnBench, DrivesAnswerEachCycleWithTheStateOfTheLastCommand) {
  const auto config = robot();
  LinuxBoard board(board_config());
  Cycle cycle(board);
  cycle.run(30, request(DriveRequest::enable));
  int answered = 0;
  cycle.run(200, request(DriveRequest::run, 0.3), [&](const SensorFrame& frame) {
    for (const auto& motor : frame.motor) {
      answered += motor.fresh;
      EXPECT_LE(frame.time_ns - motor.time_ns, kCycle_ns + kCycle_ns / 10);
      EXPECT_EQ(motor.error_code, 0);
    }
  });
  EXPECT_EQ(answered, 400);
  for (std::size_t i = 0; i < kMotorCount; ++i)
    EXPECT_NEAR(cycle.frame().motor[i].current_A * config.motor[i].torque_constant_Nm_per_A, 0.3, 0.06);
  cycle.run(50, request(DriveRequest::off, 0.3));
  for (const auto& motor : cycle.frame().motor) EXPECT_NEAR(motor.current_A, 0.0, 0.7) << "torque has gone";
  for (const auto& motor : board.status().motor) {
    EXPECT_EQ(motor.missed, 0U);
    EXPECT_EQ(motor.unsolicited, 0U);
    EXPECT_EQ(motor.rejected, 0U);
  }
}

TEST(LinuxBoardOnBench, ReadAndWriteAllocateNothing) {
  LinuxBoard board(board_config());
  Cycle cycle(board);
  cycle.run(20, request(DriveRequest::run, 0.1));
  SensorFrame frame;
  const auto command = request(DriveRequest::run, 0.1);
  std::uint64_t allocations = 0;
  int fresh = 0;
  for (int i = 0; i < 100; ++i) {
    sleep_ns(kCycle_ns);
    const AllocationGuard guard;
    board.read(frame);
    board.write(command);
    allocations += guard.count();
    fresh += frame.motor[0].fresh && frame.imu_body.fresh;
  }
  EXPECT_EQ(allocations, 0U);
  EXPECT_EQ(fresh, 100);
}

TEST(LinuxBoardOnBench, TheEmergencyStopIsSeenInTheNextCycle) {
  LinuxBoard board(board_config());
  Cycle cycle(board);
  cycle.run(2);
  EXPECT_FALSE(cycle.frame().emergency_stop);
  bench::tell_bench("estop press");
  cycle.run(1);
  EXPECT_TRUE(cycle.frame().emergency_stop);
  bench::tell_bench("estop release");
  cycle.run(1);
  EXPECT_FALSE(cycle.frame().emergency_stop);
}

TEST(LinuxBoardOnBench, AnEmergencyStopTappedBetweenTwoCyclesIsSeenOnce) {
  LinuxBoard board(board_config());
  Cycle cycle(board);
  cycle.run(2);
  EXPECT_FALSE(cycle.frame().emergency_stop);
  bench::tell_bench("estop press");
  bench::tell_bench("estop release");
  cycle.run(1);
  EXPECT_TRUE(cycle.frame().emergency_stop);
  cycle.run(1);
  EXPECT_FALSE(cycle.frame().emergency_stop);
}

TEST(LinuxBoardOnBench, WithoutADataReadyLineTheImuIsPolled) {
  auto config = board_config().imu_body;
  config.data_ready = {};
  ImuReader reader("imu_body", config);
  ImuSample sample;
  const auto begin_ns = monotonic_ns();
  int samples = 0;
  std::int64_t last_ns = 0;
  while (monotonic_ns() - begin_ns < 500 * kCycle_ns) {
    if (!reader.acquire(sample)) continue;
    EXPECT_GT(sample.time_ns, last_ns);
    last_ns = sample.time_ns;
    ++samples;
  }
  EXPECT_NEAR(samples, 833, 0.05 * 833);
}

void send_on_bus(const can_frame& frame) {
  CanSocket socket(board_config().can.interface, {});
  ASSERT_TRUE(socket.send(frame));
}

TEST(LinuxBoardOnBench, BusOffIsLatchedAndOnlyOffIsSentAfterwards) {
  struct Tap : CanTap {
    void on_frame(const can_frame& frame, std::int64_t, bool sent) noexcept override {
      if (!sent) return;
      MitPayload payload{};
      std::copy_n(frame.data, payload.size(), payload.begin());
      const auto command = unpack_mit_command(MitRanges{}, payload);
      torque += payload != kMitLeave && payload != kMitEnter && std::abs(command.torque_Nm) > 0.01;
    }
    int torque = 0;
  } tap;
  LinuxBoard board(board_config(), &tap);
  Cycle cycle(board);
  cycle.run(20, request(DriveRequest::run, 0.3));
  EXPECT_GT(tap.torque, 0);
  EXPECT_EQ(cycle.frame().bus.state, BusState::active);
  can_frame bus_off{};
  bus_off.can_id = CAN_ERR_FLAG | CAN_ERR_BUSOFF;
  bus_off.can_dlc = CAN_ERR_DLC;
  send_on_bus(bus_off);
  cycle.run(1, request(DriveRequest::run, 0.3));
  EXPECT_EQ(cycle.frame().bus.state, BusState::off);
  EXPECT_EQ(board.status().can.state, BusState::off);
  tap.torque = 0;
  cycle.run(50, request(DriveRequest::run, 0.3));
  EXPECT_EQ(tap.torque, 0);
}

TEST(LinuxBoardOnBench, RepliesThatNobodyReadInTimeAreCounted) {
  LinuxBoard board(board_config());
  Cycle cycle(board);
  cycle.run(5);
  CanSocket node(board_config().can.interface, {});
  can_frame reply{};
  reply.can_dlc = 8;
  reply.data[0] = 1;
  for (int i = 0; i < 2000; ++i) node.send(reply);
  cycle.run(1);
  node.send(reply);
  cycle.run(1);
  EXPECT_GT(board.status().can.receive_overflows, 1000U);
  EXPECT_EQ(cycle.frame().bus.receive_overflows, board.status().can.receive_overflows);
}

std::string start_error(const LinuxBoardConfig& config) {
  try {
    const LinuxBoard board(config);
  } catch (const DeviceError& error) {
    return error.what();
  }
  return "";
}

TEST(LinuxBoardOnBench, ADriveThatDoesNotAnswerIsNamed) {
  auto config = board_config();
  config.can.motor[1].can_id = 9;
  EXPECT_THAT(start_error(config),
              ::testing::AllOf(::testing::HasSubstr("motor right (can_id 9 on vcan0): no answer"),
                               ::testing::Not(::testing::HasSubstr("motor left"))));
}

TEST(LinuxBoardOnBench, ADriveInServoModeIsNotEnergised) {
  std::atomic<bool> stop = false;
  std::thread servo([&] {
    CanSocket node(board_config().can.interface, {});
    can_frame status{};
    status.can_id = CAN_EFF_FLAG | 0x2901U;
    status.can_dlc = 8;
    while (!stop) {
      node.send(status);
      sleep_ns(2 * kCycle_ns);
    }
  });
  const auto error = start_error(board_config());
  stop = true;
  servo.join();
  EXPECT_THAT(error, ::testing::HasSubstr("motor left (can_id 1 on vcan0): sends frames of another dialect"));
}

TEST(LinuxBoardOnBench, AWrongChipAndATakenLineAreNamed) {
  auto config = board_config();
  config.load_cell.address = 0x4A;
  config.estop.line = config.body_catch.line;
  EXPECT_THAT(start_error(config), ::testing::AllOf(::testing::HasSubstr("ADS1115 at address 74"),
                                                    ::testing::HasSubstr("cannot take the line")));
}

}  // namespace
}  // namespace sandhopper
