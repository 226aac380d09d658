#include <gtest/gtest.h>

#include <algorithm>

#include "drivers/can/mit_protocol.hpp"
#include "tests/faults/setup.hpp"
#include "tools/faults/bench_board.hpp"

// Frames to leave motor mode are repeated until the drives confirm it. A missing confirmation is reported.
namespace sandhopper::faults {
namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr std::array kDialects{Dialect::mit, Dialect::servo, Dialect::v3};
constexpr std::array kSides{Side::left, Side::right};

struct Running {
  explicit Running(Dialect dialect) : world(WorldConfig{}, {}, 0) {
    CanConfig can = can_of(shipped_setup().robot);
    for (auto& motor : can.motor) motor.dialect = dialect;
    auto made = std::make_unique<EmulatedBus>(world, can, 1);
    bus = made.get();
    driver = std::make_unique<CubeMarsDrives>(can, std::move(made));
    driver->probe();
    cycles(DriveRequest::run, 100);
    EXPECT_NEAR(bus->command(Side::left).torque_Nm, 0.7, 0.02) << name_of(dialect);
  }
  void cycles(DriveRequest request, int count) {
    for (int i = 0; i < count; ++i) {
      world.advance_to(world.now_ns() + kMs);
      bus->advance();
      driver->drain([](const MotorReading&) {});
      std::array<MotorCommand, kMotorCount> command{};
      for (auto& c : command) c.torque_Nm = 0.7;
      driver->command(command, request, world.now_ns());
    }
  }
  double most_told_Nm() const {
    double most = 0.0;
    for (const auto side : kSides)
      if (bus->enabled(side)) most = std::max(most, std::abs(bus->command(side).torque_Nm));
    return most;
  }

  World world;
  EmulatedBus* bus = nullptr;
  std::unique_ptr<CubeMarsDrives> driver;
};

TEST(ShutDown, OnASoundBusIsConfirmedInAFewCycles) {
  for (const auto dialect : kDialects) {
    Running r(dialect);
    const auto begin_ns = r.world.now_ns();
    EXPECT_TRUE(r.driver->shut_down()) << name_of(dialect);
    EXPECT_LT(r.most_told_Nm(), 0.02);
    for (const auto side : kSides) {
      EXPECT_FALSE(r.driver->may_be_on(side));
      EXPECT_TRUE(dialect != Dialect::mit || !r.bus->enabled(side));
    }
    const auto took_ms = static_cast<double>(r.world.now_ns() - begin_ns) * 1e-6;
    EXPECT_LE(took_ms, 20.0);
    std::printf("  %s: confirmed after %.0f ms\n", std::string(name_of(dialect)).c_str(), took_ms);
  }
}

TEST(ShutDown, OnABlockedBusIsToldToHaveFailedInItsTime) {
  for (const auto dialect : kDialects)
    for (const auto kind : {Kind::blocked, Kind::refused, Kind::cable_off}) {
      Running r(dialect);
      r.bus->set(Device::bus, kind);
      const auto begin_ns = r.world.now_ns();
      EXPECT_FALSE(r.driver->shut_down()) << name_of(dialect) << " " << name_of(kind);
      EXPECT_NEAR(static_cast<double>(r.world.now_ns() - begin_ns), CubeMarsDrives::kShutDown_ns, 2.0 * kMs);
      for (const auto side : kSides) EXPECT_TRUE(r.driver->may_be_on(side)) << name_of(kind);
    }
}

TEST(ShutDown, WhenTheBusHealsInTimeTheDrivesAreLeft) {
  for (const auto dialect : kDialects) {
    Running r(dialect);
    r.bus->set(Device::bus, Kind::blocked);
    r.bus->heal_at(r.world.now_ns() + 200 * kMs);
    const auto begin_ns = r.world.now_ns();
    EXPECT_TRUE(r.driver->shut_down()) << name_of(dialect);
    EXPECT_GE(r.world.now_ns() - begin_ns, 200 * kMs);
    EXPECT_LT(r.most_told_Nm(), 0.02) << name_of(dialect);
    for (const auto side : kSides) EXPECT_TRUE(dialect != Dialect::mit || !r.bus->enabled(side));
  }
}

TEST(ShutDown, LostLeaveFramesAreSentAgain) {
  Running r(Dialect::mit);
  int lost = 0;
  r.bus->lose([&](const can_frame& frame) {
    return frame.can_id == 2 && std::ranges::equal(kMitLeave, frame.data) && ++lost <= 10;
  });
  EXPECT_TRUE(r.driver->shut_down());
  EXPECT_FALSE(r.bus->enabled(Side::right));
}

TEST(ShutDown, ABusThatIsOffIsNotWaitedFor) {
  Running r(Dialect::mit);
  r.bus->set(Device::bus, Kind::bus_off);
  r.cycles(DriveRequest::run, 1);
  const auto begin_ns = r.world.now_ns();
  EXPECT_FALSE(r.driver->shut_down());
  EXPECT_LE(r.world.now_ns() - begin_ns, 2 * kMs);
}

// The driver's own protection, independent of the cycle: servo drives have no gains, so the host computes
// their torque and must not use an old state.
TEST(HostLaw, IsNotWorkedOutFromAnOldState) {
  Running r(Dialect::servo);
  const auto hold = [&](int cycles) {
    std::array<MotorCommand, kMotorCount> command{};
    for (auto& c : command) c.kd_Nm_s_per_rad = 1.0, c.velocity_radps = 1.0;
    for (int i = 0; i < cycles; ++i) {
      r.world.advance_to(r.world.now_ns() + kMs);
      r.bus->advance();
      r.driver->drain([](const MotorReading&) {});
      r.driver->command(command, DriveRequest::run, r.world.now_ns());
    }
    return r.bus->command(Side::left).torque_Nm;
  };
  EXPECT_NEAR(hold(20), 1.0, 0.2) << "the leg is held: 1 N m s/rad times 1 rad/s";
  r.bus->set(Device::bus, Kind::lost);
  EXPECT_NEAR(hold(4), 1.0, 0.2) << "two status frames lost in a row are bridged";
  EXPECT_EQ(hold(5), 0.0);
}

// Then the cycle opens the relay in the drives' supply.
TEST(Leaving, ThatIsNotConfirmedBecomesOverdue) {
  for (const auto dialect : kDialects) {
    Running r(dialect);
    r.bus->set(Device::bus, Kind::blocked);
    r.cycles(DriveRequest::off, CubeMarsDrives::kLeaveOverdue);
    EXPECT_FALSE(r.driver->leave_overdue());
    r.cycles(DriveRequest::off, 2);
    EXPECT_TRUE(r.driver->leave_overdue()) << name_of(dialect);
    Running sound(dialect);
    sound.cycles(DriveRequest::off, 200);
    EXPECT_FALSE(sound.driver->leave_overdue()) << name_of(dialect);
  }
}

}  // namespace
}  // namespace sandhopper::faults
