#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "drivers/transmit_guard/transmit_guard.hpp"
#include "tests/transmit_guard/frames.hpp"

namespace sandhopper::transmit {
namespace {

constexpr std::int64_t kMs = 1'000'000;

Limits limits_of(Dialect dialect) {
  Limits limits;
  for (std::uint32_t i = 0; i < kMotorCount; ++i) {
    limits.motor[i].dialect = dialect;
    limits.motor[i].can_id = i + 1;
    limits.motor[i].master_id = 0x11 + i;
    if (dialect == Dialect::servo) limits.motor[i].status_rate_Hz = 500.0;
  }
  return limits;
}

// A guard whose port sends every frame that passes, and a drive that answers.
class Line {
 public:
  explicit Line(Dialect dialect) : Line(limits_of(dialect)) {}
  explicit Line(const Limits& limits) : guard(limits), dialect_(limits.motor[0].dialect) {}

  void cycle(Allowance allowance = Allowance::motion, bool stop = false) {
    now_ns_ += kMs;
    guard.begin({.now_ns = now_ns_, .allowance = allowance, .emergency_stop = stop});
    guard.begin_frames();
  }
  Rule send(const can_frame& frame) {
    const auto verdict = guard.judge(frame);
    if (verdict.rule == Rule::none) guard.sent(verdict, now_ns_);
    return verdict.rule;
  }
  void answer(double position_rad = 0.0, double velocity_radps = 0.0) {
    guard.received(dialect_ == Dialect::mit ? mit_reply(1, position_rad, velocity_radps)
                                            : status(1, static_cast<int>(position_rad * 572.957795),
                                                     static_cast<int>(velocity_radps / 0.0498666)));
  }
  can_frame zero() const { return guard.zero_frame(0); }
  // Enters motor mode by the rules. Ends at the beginning of a cycle.
  void confirm(double position_rad = 0.5, double velocity_radps = 0.0) {
    cycle();
    if (dialect_ == Dialect::mit) {
      EXPECT_EQ(send(enter(1)), Rule::none);
    }
    for (int i = 0; i < 3; ++i) {
      answer(position_rad, velocity_radps);
      cycle();
      EXPECT_EQ(send(zero()), Rule::none);
    }
    answer(position_rad, velocity_radps);
    cycle();
  }

  TransmitGuard guard;

 private:
  Dialect dialect_;
  std::int64_t now_ns_ = 0;
};

Rule judged(const LawFields& fields) {
  Line line(Dialect::mit);
  line.confirm();
  return line.send(mit_law(1, fields));
}

TEST(TransmitGuard, HoldsEveryFieldAgainstItsLimitToOneCount) {
  EXPECT_EQ(judged({.torque_Nm = 2.8}), Rule::none);
  EXPECT_EQ(judged({.torque_Nm = -2.8}), Rule::none);
  EXPECT_EQ(judged({.torque_Nm = 2.82}), Rule::torque);
  EXPECT_EQ(judged({.torque_Nm = -2.82}), Rule::torque);
  EXPECT_EQ(judged({.position_rad = 0.5, .kp = 15.0}), Rule::none);
  EXPECT_EQ(judged({.position_rad = 0.5, .kp = 15.3}), Rule::stiffness);
  EXPECT_EQ(judged({.kd = 0.3}), Rule::none);
  EXPECT_EQ(judged({.kd = 0.303}), Rule::damping);
  EXPECT_EQ(judged({.velocity_radps = 41.0, .kd = 0.01}), Rule::speed);
  EXPECT_EQ(judged({.position_rad = 0.1, .kp = 1.0}), Rule::angle);
  EXPECT_EQ(judged({.position_rad = 2.75, .kp = 1.0}), Rule::angle);
  EXPECT_EQ(judged({.position_rad = -12.5, .torque_Nm = 1.0}), Rule::none)
      << "without stiffness it does nothing";
}

TEST(TransmitGuard, CountsWhatTheVelocitySetPointAddsToTheTorque) {
  EXPECT_EQ(judged({.velocity_radps = 9.0, .kd = 0.3}), Rule::none);
  EXPECT_EQ(judged({.velocity_radps = 10.0, .kd = 0.3}), Rule::torque);
  EXPECT_EQ(judged({.velocity_radps = 5.0, .kd = 0.3, .torque_Nm = 2.0}), Rule::torque);
}

// Stiffness about a position that differs from the leg's position would make the leg jump.
TEST(TransmitGuard, LetsStiffnessBeginOnlyNearTheMeasuredAngle) {
  EXPECT_EQ(judged({.position_rad = 0.5 + 2.7 / 15.0, .kp = 15.0}), Rule::none);
  EXPECT_EQ(judged({.position_rad = 0.5 + 3.0 / 15.0, .kp = 15.0}), Rule::stiffness_far);
  Line line(Dialect::mit);
  line.confirm(0.5);
  ASSERT_EQ(line.send(mit_law(1, {.position_rad = 0.5, .kp = 15.0})), Rule::none);
  line.answer(1.5);
  line.cycle();
  EXPECT_EQ(line.send(mit_law(1, {.position_rad = 0.5, .kp = 15.0})), Rule::none)
      << "the leg was pushed away";
}

TEST(TransmitGuard, KnowsIdentifierLengthAndDialectOfItsMotorsOnly) {
  Line line(Dialect::mit);
  line.cycle();
  EXPECT_EQ(line.send(mit_law(3, {})), Rule::identifier);
  EXPECT_EQ(line.send(mit_law(1 | CAN_EFF_FLAG, {})), Rule::identifier);
  EXPECT_EQ(line.send(mit_law(1 | CAN_RTR_FLAG, {})), Rule::identifier);
  EXPECT_EQ(line.send(v3_law(1, {})), Rule::identifier);
  EXPECT_EQ(line.send(servo_current(1, 0)), Rule::identifier);
  auto frame = mit_law(1, {});
  frame.can_dlc = 7;
  EXPECT_EQ(line.send(frame), Rule::length);
  frame.can_dlc = 200;
  EXPECT_EQ(line.send(frame), Rule::length);
  EXPECT_EQ(line.send(set_zero(1)), Rule::set_zero);
  // A frame in the other dialect's layout with this dialect's identifier.
  auto swapped = v3_law(1, {});
  swapped.can_id = 1;
  EXPECT_THAT(line.send(swapped), ::testing::AnyOf(Rule::stiffness, Rule::damping)) << "full of gains here";
}

TEST(TransmitGuard, WantsAnEnterFrameAndTwoRepliesBeforeTorque) {
  Line line(Dialect::mit);
  const auto torque = mit_law(1, {.torque_Nm = 0.1});
  const auto damping = mit_law(1, {.kd = 0.1});
  for (int i = 0; i < 5; ++i) {
    line.cycle();
    line.answer();
    EXPECT_EQ(line.send(torque), Rule::not_confirmed) << "answers without an enter frame";
  }
  line.cycle();
  EXPECT_EQ(line.send(enter(1)), Rule::none);
  line.cycle();
  EXPECT_EQ(line.send(torque), Rule::not_confirmed);
  line.answer();
  EXPECT_EQ(line.send(torque), Rule::not_confirmed) << "it may answer a command before";
  EXPECT_EQ(line.send(damping), Rule::not_confirmed);
  line.answer();
  EXPECT_EQ(line.guard.judge(damping).rule, Rule::none);
  EXPECT_EQ(line.send(torque), Rule::none);
  line.cycle();
  EXPECT_EQ(line.send(leave(1)), Rule::none);
  line.answer();
  line.answer();
  line.cycle();
  EXPECT_EQ(line.send(torque), Rule::not_confirmed) << "left again";
}

TEST(TransmitGuard, TakesACommandWithoutTorqueForEnteringWhereThereIsNoEnterFrame) {
  for (const auto dialect : {Dialect::servo, Dialect::v3}) {
    Line line(dialect);
    const auto torque = dialect == Dialect::servo ? servo_current(1, 1000) : v3_law(1, {.torque_Nm = 0.1});
    line.cycle();
    line.answer();
    line.answer();
    EXPECT_EQ(line.send(torque), Rule::not_confirmed);
    line.confirm();
    EXPECT_EQ(line.send(torque), Rule::none);
  }
}

TEST(TransmitGuard, EndsTorqueButNotDampingWhenTheDriveIsSilent) {
  Line line(Dialect::mit);
  line.confirm();
  const auto torque = mit_law(1, {.torque_Nm = 0.1});
  for (int i = 0; i <= 5; ++i) {
    EXPECT_EQ(line.send(torque), Rule::none) << i;
    line.cycle();
  }
  EXPECT_EQ(line.send(torque), Rule::unanswered);
  EXPECT_EQ(line.send(mit_law(1, {.kd = 0.1})), Rule::none);
}

TEST(TransmitGuard, GrantsWhatTheFaultsReactionNeedsAndNoMore) {
  const auto rule = [](Allowance allowance, const LawFields& fields) {
    Line line(Dialect::mit);
    line.confirm();
    line.cycle(allowance);
    return line.guard.judge(mit_law(1, fields)).rule;
  };
  const LawFields torque{.torque_Nm = 0.1}, hold{.position_rad = 0.5, .kp = 10.0, .kd = 0.3}, damp{.kd = 0.3};
  EXPECT_EQ(rule(Allowance::holding, torque), Rule::restricted);
  EXPECT_EQ(rule(Allowance::holding, hold), Rule::none);
  EXPECT_EQ(rule(Allowance::holding, damp), Rule::none);
  EXPECT_EQ(rule(Allowance::damping, torque), Rule::restricted);
  EXPECT_EQ(rule(Allowance::damping, hold), Rule::restricted);
  EXPECT_EQ(rule(Allowance::damping, damp), Rule::none);
  EXPECT_EQ(rule(Allowance::no_torque, damp), Rule::restricted);
  EXPECT_EQ(rule(Allowance::no_torque, {}), Rule::none);
  EXPECT_EQ(rule(Allowance::damping, {.velocity_radps = 5.0, .kd = 0.3}), Rule::restricted)
      << "drives the leg";
}

TEST(TransmitGuard, LetsOnlyTorqueFreeFramesOutWhileTheEmergencyStopIsOpen) {
  Line line(Dialect::mit);
  line.confirm();
  line.cycle(Allowance::motion, true);
  EXPECT_EQ(line.send(mit_law(1, {.torque_Nm = 0.1})), Rule::stopped);
  EXPECT_EQ(line.send(mit_law(1, {.kd = 0.1})), Rule::stopped);
  EXPECT_EQ(line.send(enter(1)), Rule::stopped);
  EXPECT_EQ(line.send(mit_law(1, {})), Rule::none);
  EXPECT_EQ(line.send(leave(1)), Rule::none);
  line.answer();
  line.cycle();
  EXPECT_EQ(line.send(mit_law(1, {.torque_Nm = 0.1})), Rule::not_confirmed) << "closed again: enter anew";
}

TEST(TransmitGuard, LetsNothingWithTorqueOutBeforeItIsToldTheEmergencyStop) {
  Line line(Dialect::mit);
  EXPECT_EQ(line.send(enter(1)), Rule::stopped);
  EXPECT_EQ(line.send(mit_law(1, {})), Rule::none);
}

TEST(TransmitGuard, KeepsADriveOutOfMotorModeWhileAFaultIsLatchedOrALoadRemembered) {
  for (const auto allowance : {Allowance::holding, Allowance::damping, Allowance::no_torque}) {
    Line line(Dialect::mit);
    line.cycle(allowance);
    EXPECT_EQ(line.send(enter(1)), Rule::restricted);
  }
  Line line(Dialect::mit);
  line.confirm();
  EXPECT_EQ(line.send(mit_law(1, {.torque_Nm = 1.0})), Rule::none);
  line.answer();
  line.cycle();
  EXPECT_EQ(line.send(enter(1)), Rule::enter_loaded) << "the drive would start with that torque";
  EXPECT_EQ(line.send(mit_law(1, {})), Rule::none);
  line.answer();
  line.cycle();
  EXPECT_EQ(line.send(enter(1)), Rule::none);
}

TEST(TransmitGuard, HoldsServoDampingAgainstTheMeasuredMotion) {
  const auto rule = [](double velocity_radps, double torque_Nm) {
    Line line(Dialect::servo);
    line.confirm(0.5, velocity_radps);
    line.cycle(Allowance::damping);
    return line.send(servo_current(1, static_cast<std::int32_t>(std::lround(torque_Nm / 0.0868 * 1000.0))));
  };
  EXPECT_EQ(rule(5.0, -1.4), Rule::none);
  EXPECT_EQ(rule(5.0, 1.4), Rule::damping) << "with the motion";
  EXPECT_EQ(rule(5.0, -1.7), Rule::damping) << "more than kd times the speed";
  EXPECT_EQ(rule(-5.0, 1.4), Rule::none);
  EXPECT_EQ(rule(0.0, 0.2), Rule::damping);
  EXPECT_EQ(rule(0.0, 0.0), Rule::none);
}

TEST(TransmitGuard, EndsServoDampingWhenTheMotionIsNotKnownAnyMore) {
  Line line(Dialect::servo);
  line.confirm(0.5, 5.0);
  const auto against = servo_current(1, -5000);
  int passed = 0;
  for (int i = 0; i < 20; ++i) {
    passed += line.send(against) == Rule::none;
    line.cycle(Allowance::damping);
  }
  EXPECT_EQ(passed, 6);
  EXPECT_EQ(line.send(against), Rule::unanswered);
}

TEST(TransmitGuard, TakesOneFrameAMotorAndCycleAndAFewThatTakeTorqueAway) {
  Line line(Dialect::mit);
  line.confirm();
  const auto torque = mit_law(1, {.torque_Nm = 0.1});
  EXPECT_EQ(line.send(torque), Rule::none);
  line.answer();
  EXPECT_EQ(line.send(torque), Rule::second_frame);
  EXPECT_EQ(line.send(line.zero()), Rule::none);
  EXPECT_EQ(line.send(leave(1)), Rule::none);
  EXPECT_EQ(line.send(leave(1)), Rule::none);
  EXPECT_EQ(line.send(leave(1)), Rule::second_frame);
}

TEST(TransmitGuard, KeepsOneCommandOutstanding) {
  Line line(Dialect::mit);
  line.confirm();
  const auto torque = mit_law(1, {.torque_Nm = 0.1});
  EXPECT_EQ(line.send(torque), Rule::none);
  line.guard.begin_frames();
  line.guard.advance(400'000);
  EXPECT_EQ(line.send(torque), Rule::outstanding);
  EXPECT_EQ(line.guard.judge(line.zero()).rule, Rule::none);
  line.guard.advance(200'000);
  EXPECT_EQ(line.send(torque), Rule::none) << "lost by now";
}

// Two V3 drives need 4 frames of 160 bits per cycle: 64 % of 1 Mbit/s at 1 kHz.
TEST(TransmitGuard, KeepsTheBusLoadBelowItsShare) {
  for (const auto& [step_ns, held] : {std::pair{1'000'000, true}, std::pair{600'000, false}}) {
    auto limits = limits_of(Dialect::v3);
    TransmitGuard guard(limits);
    bool all_passed = true;
    for (std::int64_t i = 1; i < 100; ++i) {
      guard.begin({.now_ns = i * step_ns, .allowance = Allowance::motion, .emergency_stop = false});
      guard.begin_frames();
      for (std::uint32_t id = 1; id <= 2; ++id) {
        const auto verdict = guard.judge(v3_law(id, {.torque_Nm = i > 3 ? 0.1 : 0.0}));
        all_passed = all_passed && verdict.rule == Rule::none;
        if (verdict.rule == Rule::none) guard.sent(verdict, i * step_ns);
        EXPECT_TRUE(verdict.rule == Rule::none || verdict.rule == Rule::bus_load);
        guard.received(status(id, 0, 0));
      }
    }
    EXPECT_EQ(all_passed, held) << step_ns;
  }
}

TEST(TransmitGuard, LetsOnlyTorqueFreeFramesOutAfterARefusal) {
  Line line(Dialect::mit);
  line.confirm();
  line.guard.refused();
  EXPECT_EQ(line.send(mit_law(1, {.kd = 0.1})), Rule::latched);
  EXPECT_EQ(line.send(enter(1)), Rule::latched);
  EXPECT_EQ(line.send(mit_law(1, {})), Rule::none);
  EXPECT_EQ(line.send(leave(1)), Rule::none);
}

TEST(TransmitGuard, RefusesEverythingWhereALimitIsNoNumber) {
  auto limits = limits_of(Dialect::mit);
  limits.motor[0].torque_Nm = std::nan("");
  Line line(limits);
  line.confirm();
  EXPECT_EQ(line.send(mit_law(1, {.torque_Nm = 0.1})), Rule::torque);
}

}  // namespace
}  // namespace sandhopper::transmit
