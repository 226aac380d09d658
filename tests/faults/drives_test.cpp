#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "drivers/can/mit_protocol.hpp"
#include "firmware/controller.hpp"
#include "firmware/refusal_text.hpp"
#include "tests/faults/setup.hpp"
#include "tools/faults/bench_board.hpp"

// Motor mode must be confirmed, not assumed. The whole cycle runs with the robot's driver on the emulated
// bus.
namespace sandhopper::faults {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr std::int64_t kMs = 1'000'000;
constexpr std::array kDialects{Dialect::mit, Dialect::servo, Dialect::v3};
constexpr std::array kSides{Side::left, Side::right};

RobotConfig robot_with(Dialect dialect) {
  auto robot = shipped_setup().robot;
  for (auto& motor : robot.motor) motor.dialect = dialect;
  return robot;
}

class Trial {
 public:
  explicit Trial(Dialect dialect = Dialect::mit)
      : robot_(robot_with(dialect)),
        world_(WorldConfig{}, {}, 0),
        board_(world_, robot_, 1),
        controller_(cycle_config(robot_)) {
    run(300);
  }

  // Runs one cycle; its command acts until the next one.
  void turn(Request request = Request::none) {
    ++cycle_;
    frame_.time_ns = static_cast<std::int64_t>(cycle_) * kMs;
    frame_.cycle = cycle_;
    frame_.request = request;
    board_.read(frame_);
    const auto& output = controller_.step(frame_);
    board_.write(output.command);
    state_ = output.state;
    drive_ = output.command.drive;
    for (const auto& event : controller_.events()) events_.push_back(event);
  }
  void run(int cycles) {
    for (int i = 0; i < cycles; ++i) turn();
  }
  void ask(Request request) { turn(request); }
  // Runs until an event of this kind; returns null if there is none.
  const Event* until(EventKind kind, int cycles = 3000) {
    const auto seen = events_.size();
    for (int i = 0; i < cycles; ++i) {
      for (std::size_t k = seen; k < events_.size(); ++k)
        if (events_[k].kind == kind) return &events_[k];
      turn();
    }
    return nullptr;
  }
  bool until_state(State state) {
    for (int i = 0; i < 3000 && state_ != state; ++i) turn();
    return state_ == state;
  }
  int count(EventKind kind) const {
    return static_cast<int>(std::ranges::count(events_, kind, &Event::kind));
  }
  const Event& last() const { return events_.back(); }

  State state() const { return state_; }
  DriveRequest drive() const { return drive_; }
  BenchBoard& board() { return board_; }
  EmulatedBus& bus() { return board_.bus(); }
  const World& world() const { return world_; }
  bool any_on() { return bus().enabled(Side::left) || bus().enabled(Side::right); }
  bool both_on() { return bus().enabled(Side::left) && bus().enabled(Side::right); }

 private:
  RobotConfig robot_;
  World world_;
  BenchBoard board_;
  Controller controller_;
  SensorFrame frame_{};
  std::uint64_t cycle_ = 0;
  State state_ = State::idle;
  DriveRequest drive_ = DriveRequest::off;
  std::vector<Event> events_;
};

bool is_enter(const can_frame& frame, canid_t id) {
  return frame.can_id == id && std::ranges::equal(kMitEnter, frame.data);
}

TEST(Arming, OneLostEnterFrameIsSentAgainBeforeTheRobotIsArmed) {
  for (const canid_t id : {1U, 2U}) {
    Trial trial;
    int entered = 0;
    trial.bus().lose([&](const can_frame& frame) { return is_enter(frame, id) && entered++ == 0; });
    trial.ask(Request::arm);
    ASSERT_NE(trial.until(EventKind::armed), nullptr);
    EXPECT_EQ(entered, 2) << "the whole sequence once more";
    EXPECT_TRUE(trial.both_on());
    trial.run(100);
    trial.ask(Request::release);
    ASSERT_NE(trial.until(EventKind::liftoff), nullptr);
    EXPECT_EQ(trial.count(EventKind::fault_raised), 0);
  }
}

// Servo and v3 have no frame to enter motor mode. In these dialects a drive without torque replaces the drive
// that is not in motor mode.
TEST(Arming, ADriveThatIsNotInMotorModeIsNamedAndTheOtherIsNot) {
  for (const auto dialect : kDialects)
    for (const auto side : kSides) {
      Trial trial(dialect);
      const auto id = side == Side::left ? 1U : 2U;
      trial.bus().lose([&](const can_frame& frame) { return is_enter(frame, id); });
      if (dialect != Dialect::mit) trial.bus().ignore_torque(side);
      trial.ask(Request::arm);
      const auto* refused = trial.until(EventKind::arming_refused);
      ASSERT_NE(refused, nullptr) << name_of(dialect);
      EXPECT_EQ(refused->reason, Reason::drives_not_confirmed);
      const auto text = refusal_text(*refused);
      EXPECT_THAT(text, HasSubstr(side == Side::left ? "left motor" : "right motor"));
      EXPECT_THAT(text, Not(HasSubstr(side == Side::left ? "right motor" : "left motor")));
      EXPECT_THAT(text, HasSubstr("after 3 tries"));
      EXPECT_EQ(trial.count(EventKind::armed), 0);
      trial.run(20);
      EXPECT_EQ(trial.state(), State::idle);
      EXPECT_TRUE(dialect != Dialect::mit || !trial.any_on());
      std::printf("%s: %s\n", std::string(name_of(dialect)).c_str(), text.c_str());
    }
}

TEST(Arming, TheTestTorqueIsSmallAndTheLegStays) {
  for (const auto dialect : kDialects) {
    Trial trial(dialect);
    trial.bus().reset_torque();
    const auto before_rad = trial.world().truth().leg_angle_rad;
    trial.ask(Request::arm);
    ASSERT_NE(trial.until(EventKind::armed), nullptr) << name_of(dialect);
    EXPECT_NEAR(trial.bus().most_torque_Nm(), 0.1, 0.01) << name_of(dialect);
    EXPECT_NEAR(trial.world().truth().leg_angle_rad, before_rad, 1e-3);
    EXPECT_EQ(trial.count(EventKind::fault_raised), 0);
  }
}

TEST(Arming, AfterAFaultTheWholeSequenceRunsAgain) {
  Trial trial;
  int entered = 0, left = 0;
  trial.bus().lose([&](const can_frame& frame) {
    entered += is_enter(frame, 1);
    left += frame.can_id == 1 && std::ranges::equal(kMitLeave, frame.data);
    return false;
  });
  trial.ask(Request::arm);
  ASSERT_NE(trial.until(EventKind::armed), nullptr);
  trial.board().set(Device::estop, Kind::tapped);
  ASSERT_NE(trial.until(EventKind::fault_raised), nullptr);
  trial.run(50);
  EXPECT_FALSE(trial.both_on());
  entered = left = 0;
  trial.ask(Request::disarm);
  trial.ask(Request::arm);
  trial.bus().reset_torque();
  ASSERT_NE(trial.until(EventKind::armed), nullptr);
  EXPECT_EQ(entered, 1);
  EXPECT_GE(left, 1);
  EXPECT_GT(trial.bus().most_torque_Nm(), 0.09) << "the test torque";
}

TEST(Foreign, OneFrameOfAnotherDialectNeedsARestart) {
  Trial trial;
  trial.ask(Request::arm);
  ASSERT_NE(trial.until(EventKind::armed), nullptr);
  trial.board().set(Device::bus, Kind::foreign);
  trial.turn();
  trial.board().set(Device::bus, std::nullopt);
  trial.run(50);
  EXPECT_EQ(trial.state(), State::fault);
  trial.ask(Request::disarm);
  EXPECT_EQ(trial.last().kind, EventKind::disarm_refused);
  trial.ask(Request::arm);
  trial.run(1000);
  EXPECT_EQ(trial.count(EventKind::armed), 1) << "before the fault";
}

// A fault's latch and the driver's state must agree: if the robot can be armed after a fault, its drives must
// make torque.
TEST(Faults, NoneOfTheBusLeavesARobotThatArmsWithoutTorque) {
  for (const auto dialect : kDialects)
    for (int k = static_cast<int>(Kind::cable_off); k <= static_cast<int>(Kind::protocol_error); ++k) {
      const auto kind = static_cast<Kind>(k);
      Trial trial(dialect);
      trial.ask(Request::arm);
      ASSERT_NE(trial.until(EventKind::armed), nullptr);
      trial.board().set(Device::bus, kind);
      trial.run(20);
      trial.board().set(Device::bus, std::nullopt);
      trial.run(2000);
      trial.ask(Request::disarm);
      trial.bus().reset_torque();
      trial.ask(Request::arm);
      const bool armed = trial.until(EventKind::armed, 1000) != nullptr;
      const bool on = trial.both_on() && trial.bus().most_torque_Nm() > 0.09;
      EXPECT_TRUE(armed ? on : trial.state() != State::armed) << name_of(dialect) << " " << name_of(kind);
      std::printf("  %-5s %-14s %s\n", std::string(name_of(dialect)).c_str(),
                  std::string(name_of(kind)).c_str(), armed ? "arms again, drives on" : "does not arm");
    }
}

// Work of the motors on the leg, from two cycles after the fault on, when the current has decayed.
double work_after_fault_J(Trial& trial, int cycles) {
  trial.run(2);
  double work_J = 0.0;
  for (int i = 0; i < cycles; ++i) {
    trial.turn();
    const auto& truth = trial.world().truth();
    work_J += truth.motor_torque_Nm * truth.leg_velocity_radps * 1e-3;
  }
  return work_J;
}

void hop_into_extension(Trial& trial) {
  trial.ask(Request::arm);
  ASSERT_NE(trial.until(EventKind::armed), nullptr);
  trial.ask(Request::release);
  ASSERT_TRUE(trial.until_state(State::extension));
  trial.run(8);
}

TEST(Reactions, WithoutStatusFramesNoWorkIsDoneOnTheLeg) {
  for (const auto dialect : kDialects) {
    Trial trial(dialect);
    ASSERT_NO_FATAL_FAILURE(hop_into_extension(trial));
    trial.board().set(Device::bus, Kind::lost);
    const auto* fault = trial.until(EventKind::fault_raised, 20);
    ASSERT_NE(fault, nullptr);
    EXPECT_EQ(fault->fault, Fault::motor_reply_lost);
    const double work_J = work_after_fault_J(trial, 1000);
    EXPECT_LE(work_J, 0.001) << name_of(dialect);
    std::printf("  %s: %.3f J done on the leg after the fault\n", std::string(name_of(dialect)).c_str(),
                work_J);
  }
}

TEST(Reactions, AFreshVelocityStillDamps) {
  for (const auto dialect : kDialects) {
    Trial trial(dialect);
    ASSERT_NO_FATAL_FAILURE(hop_into_extension(trial));
    trial.board().set(Device::imu_body, Kind::future);
    ASSERT_NE(trial.until(EventKind::fault_raised, 20), nullptr);
    const double work_J = work_after_fault_J(trial, 500);
    EXPECT_LT(work_J, -0.05) << name_of(dialect);
  }
}

}  // namespace
}  // namespace sandhopper::faults
