#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/can/torque_cut.hpp"
#include "drivers/device_error.hpp"
#include "firmware/controller.hpp"
#include "tests/faults/setup.hpp"
#include "tools/faults/bench_board.hpp"

// The driver against emulated drives of each dialect. The emulation shares no code with the driver.
namespace sandhopper::faults {
namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr std::array kDialects{Dialect::mit, Dialect::servo, Dialect::v3};

CanConfig can_with(Dialect dialect) {
  CanConfig can = can_of(shipped_setup().robot);
  for (auto& motor : can.motor) motor.dialect = dialect;
  return can;
}

// Drives of one dialect, and a driver that assumes the same or another one.
struct Bench {
  Bench(Dialect drives_speak, Dialect driver_believes)
      : world(WorldConfig{}, {}, 0), driver(can_with(driver_believes), make_bus(can_with(drives_speak))) {}

  std::unique_ptr<CanPort> make_bus(const CanConfig& can) {
    auto made = std::make_unique<EmulatedBus>(world, can, 1);
    bus = made.get();
    return made;
  }

  MotorSample newest;
  int replies = 0;
  void cycle(DriveRequest request, double torque_Nm) {
    world.advance_to(world.now_ns() + kMs);
    bus->advance();
    driver.drain([&](const MotorReading& reading) {
      newest = reading.sample;
      ++replies;
    });
    std::array<MotorCommand, kMotorCount> command{};
    for (auto& c : command) c.torque_Nm = torque_Nm;
    driver.command(command, request, world.now_ns());
  }

  World world;
  EmulatedBus* bus = nullptr;
  CubeMarsDrives driver;
};

TEST(Dialects, EachIsProbedEnabledRunAndLeftWithoutAKick) {
  for (const auto dialect : kDialects) {
    Bench bench(dialect, dialect);
    ASSERT_NO_THROW(bench.driver.probe()) << name_of(dialect);
    EXPECT_LT(bench.bus->most_torque_Nm(), 0.02) << name_of(dialect) << ": probing makes no torque";
    for (int i = 0; i < 20; ++i) bench.cycle(DriveRequest::enable, 1.0);
    EXPECT_LT(bench.bus->most_torque_Nm(), 0.02) << name_of(dialect) << ": enabling makes no torque";
    bench.replies = 0;
    for (int i = 0; i < 100; ++i) bench.cycle(DriveRequest::run, 0.7);
    EXPECT_NEAR(bench.bus->command(Side::left).torque_Nm, 0.7, 0.02) << name_of(dialect);
    EXPECT_NEAR(bench.newest.current_A * 0.0868, 0.7, 0.06) << name_of(dialect);
    EXPECT_GE(bench.replies, dialect == Dialect::servo ? 98 : 198) << name_of(dialect);
    bench.driver.shut_down();
    EXPECT_LT(std::abs(bench.bus->command(Side::left).torque_Nm), 0.02) << name_of(dialect);
    EXPECT_LT(std::abs(bench.bus->command(Side::right).torque_Nm), 0.02) << name_of(dialect);
  }
}

TEST(Dialects, ADriveOfAnotherDialectIsRefusedBeforeAnyTorque) {
  for (const auto drives : kDialects)
    for (const auto believed : kDialects) {
      if (drives == believed) continue;
      Bench bench(drives, believed);
      try {
        bench.driver.probe();
        ADD_FAILURE() << name_of(drives) << " drives passed as " << name_of(believed);
      } catch (const DeviceError& error) {
        std::printf("%s drives, configured %s: %.110s\n", std::string(name_of(drives)).c_str(),
                    std::string(name_of(believed)).c_str(), error.what());
      }
      EXPECT_LT(bench.bus->most_torque_Nm(), 0.02) << name_of(drives) << " as " << name_of(believed);
    }
}

TEST(Dialects, ADriveThatChangesItsDialectLaterGetsNoMoreTorque) {
  Bench bench(Dialect::mit, Dialect::mit);
  bench.driver.probe();
  for (int i = 0; i < 30; ++i) bench.cycle(DriveRequest::run, 0.7);
  EXPECT_NEAR(bench.bus->command(Side::left).torque_Nm, 0.7, 0.02);
  bench.bus->set(Device::bus, Kind::foreign);
  for (int i = 0; i < 3; ++i) bench.cycle(DriveRequest::run, 0.7);
  EXPECT_LT(std::abs(bench.bus->command(Side::left).torque_Nm), 0.02);
}

TEST(Dialects, TheWatchdogsFramesTakeTheTorqueFromEach) {
  for (const auto dialect : kDialects) {
    Bench bench(dialect, dialect);
    bench.driver.probe();
    for (int i = 0; i < 100; ++i) bench.cycle(DriveRequest::run, 0.7);
    ASSERT_NEAR(bench.bus->command(Side::right).torque_Nm, 0.7, 0.02) << name_of(dialect);
    const auto frames = torque_cut_frames(can_with(dialect));
    EXPECT_EQ(frames.size(), dialect == Dialect::mit ? 4U : 2U) << name_of(dialect);
    for (const auto& frame : frames) bench.bus->send(frame);
    for (const auto side : {Side::left, Side::right}) {
      EXPECT_LT(std::abs(bench.bus->command(side).torque_Nm), 0.02) << name_of(dialect);
      EXPECT_LT(bench.bus->command(side).kp_Nm_per_rad + bench.bus->command(side).kd_Nm_s_per_rad, 0.01)
          << name_of(dialect);
      EXPECT_EQ(bench.bus->enabled(side), dialect != Dialect::mit) << name_of(dialect);
    }
  }
}

// A drive error while hopping must be found in each dialect and switch the drives off.
TEST(Dialects, EachHopsAndADriveErrorEndsIt) {
  for (const auto dialect : kDialects) {
    auto setup = shipped_setup();
    for (auto& motor : setup.robot.motor) motor.dialect = dialect;
    const Cell cell{.device = Device::motor_left,
                    .kind = Kind::error,
                    .phase = Phase::extension,
                    .expected = Fault::drive_error};
    const auto result = run_cell(cell, setup);
    EXPECT_EQ(result.problem, "") << name_of(dialect);
    std::printf("%s: hops to extension; drive error seen after %d cycles, %s, torque %s\n",
                std::string(name_of(dialect)).c_str(), result.cycles,
                std::string(name_of(result.state)).c_str(), result.torque.c_str());
  }
}

TEST(Bus, AQueueThatIsBlockedLetsNoRowOfOldTorquesOut) {
  Bench bench(Dialect::mit, Dialect::mit);
  bench.driver.probe();
  for (int i = 0; i < 30; ++i) bench.cycle(DriveRequest::run, 0.7);
  bench.bus->set(Device::bus, Kind::blocked);
  for (int i = 0; i < 10; ++i) bench.cycle(DriveRequest::run, 0.7);
  EXPECT_GT(bench.driver.bus_sample().send_failures, 5U);
  bench.cycle(DriveRequest::off, 0.0);
  bench.bus->set(Device::bus, std::nullopt);
  EXPECT_LE(bench.bus->stale_torques(), 2) << "what the controller held when the bus stopped, one a motor";
  bench.cycle(DriveRequest::off, 0.0);
  EXPECT_LT(std::abs(bench.bus->command(Side::left).torque_Nm), 0.02);
}

}  // namespace
}  // namespace sandhopper::faults
