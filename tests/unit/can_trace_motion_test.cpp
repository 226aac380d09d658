#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "tests/unit/can_trace_text.hpp"

// Positions that the reported speed contradicts in a part of a trace: replies that are sent again, an encoder
// that stands, and positions that jump.
namespace sandhopper::trace {
namespace {

using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

struct State {
  double position_rad = 0.0, velocity_radps = 0.0, torque_Nm = 0.0;
};
using Motion = std::function<State(double t_s)>;

unsigned code(double value, double range, unsigned most) {
  return static_cast<unsigned>(std::lround((value + range) / (2.0 * range) * most));
}

struct Recorder {
  int replies = 400;
  double period_s = kMs;
  int batch = 1;  // so many replies reach the recorder together
  bool low_byte_first = false;
};

TraceReport report_of(const Motion& motion, const Recorder& recorder = {}) {
  TraceText trace;
  for (int i = 0; i < recorder.replies; ++i) {
    const double t = i * recorder.period_s;
    const auto state = motion(t);
    unsigned position = code(state.position_rad, 12.5, 65535);
    if (recorder.low_byte_first) position = (position & 0xFFU) << 8U | position >> 8U;
    const double in_batch = i % recorder.batch;
    const double arrival = t + (recorder.batch - 1 - in_batch) * recorder.period_s + in_batch * 0.1 * kMs;
    trace.command(t, 1).line(arrival + kReply, fmt::format("011#01{:04X}{:03X}{:03X}4600", position,
                                                           code(state.velocity_radps, 50.0, 4095),
                                                           code(state.torque_Nm, 18.0, 4095)));
  }
  return trace.report();
}

// 0.35 rad and 1 Hz: up to 2.2 rad/s.
State swing(double t_s) {
  const double rate = 2.0 * std::numbers::pi;
  return {0.35 * std::sin(rate * t_s), 0.35 * rate * std::cos(rate * t_s), std::sin(rate * t_s)};
}

const auto kStrange =
    AnyOf("frozen_replies", "frozen_position", "position_jump", "no_speed", "exchanged_bytes");

void expect_sound(const Motion& motion, const Recorder& recorder, const char* what) {
  EXPECT_THAT(kinds(report_of(motion, recorder)), Not(Contains(kStrange))) << what;
}

TEST(CanTraceMotion, ADriveThatRepeatsOneReplyWhileItMovesIsNamed) {
  const auto frozen = report_of([](double t) { return swing(std::min(t, 0.15)); });
  EXPECT_THAT(text_of(frozen, "frozen_replies"),
              AllOf(HasSubstr("motor left: 250 replies in a row from line 302 on (0.249 s)"),
                    HasSubstr("the speed in them is 1.28 rad/s: it would move 0.319 rad")));
  EXPECT_FALSE(frozen.trusted());
  const auto from_the_start = report_of([](double) { return State{1.234, 2.2, 0.0}; });
  EXPECT_THAT(text_of(from_the_start, "frozen_replies"), HasSubstr("400 replies in a row from line 2 on"));
}

TEST(CanTraceMotion, RepliesThatAreSentTenTimesAreNamedOnce) {
  const auto held = report_of([](double t) { return swing(std::floor(t * 100.0 + 1e-6) / 100.0); });
  EXPECT_THAT(text_of(held, "frozen_replies"), HasSubstr("10 replies in a row"));
  EXPECT_THAT(kinds(held), Not(Contains("position_jump"))) << "the steps follow from the repeated replies";
}

TEST(CanTraceMotion, AnEncoderThatStandsWhileTheSpeedGoesOnIsNamed) {
  const auto stands = report_of([](double t) {
    auto state = swing(t);
    if (t > 0.1 && t < 0.2) state.position_rad = swing(0.1).position_rad;
    return state;
  });
  EXPECT_THAT(text_of(stands, "frozen_position"),
              AllOf(HasSubstr("have one position"), HasSubstr("encoder")));
  EXPECT_FALSE(stands.trusted());
}

TEST(CanTraceMotion, AJumpOfThePositionIsNamedWithItsLine) {
  const auto turn = report_of([](double t) {
    auto state = swing(t);
    if (t > 0.1995) state.position_rad -= 2.0 * std::numbers::pi;
    return state;
  });
  EXPECT_THAT(text_of(turn, "position_jump"),
              AllOf(HasSubstr("before line 402"), HasSubstr("(-1 turn)"), HasSubstr("replay the parts")));
  EXPECT_FALSE(turn.trusted());
  const auto radian = [](double t) {
    auto state = swing(t);
    if (t > 0.1995) state.position_rad += 1.0;
    return state;
  };
  EXPECT_THAT(text_of(report_of(radian, {.period_s = 2 * kMs}), "position_jump"),
              AllOf(HasSubstr("jumps by +1"), Not(HasSubstr("turn)"))));
  const auto after_rest = [](double t) { return State{t < 0.3 ? 0.0 : 2.0 * std::numbers::pi, 0.0, 0.0}; };
  EXPECT_THAT(text_of(report_of(after_rest), "position_jump"), HasSubstr("(+1 turn)"));
}

TEST(CanTraceMotion, ExchangedBytesOfThePositionAreNamedAsTheCause) {
  const auto report = report_of(swing, {.low_byte_first = true});
  EXPECT_THAT(text_of(report, "exchanged_bytes"), HasSubstr("bytes 1 and 2"));
  EXPECT_THAT(kinds(report), Not(Contains(AnyOf("velocity_range", "near_range_end", "position_jump"))));
}

TEST(CanTraceMotion, ASpeedThatIsNotSentIsNamedAsTheCause) {
  const auto report = report_of([](double t) { return State{swing(t).position_rad, 0.0, 0.0}; });
  EXPECT_THAT(text_of(report, "no_speed"), HasSubstr("in all 400 replies"));
  EXPECT_THAT(kinds(report), Not(Contains("velocity_range")));
}

TEST(CanTraceMotion, ALegAtRestIsNotDoubted) {
  expect_sound([](double) { return State{1.2, 0.0, 0.5}; }, {}, "equal replies at rest");
  expect_sound([](double) { return State{1.2, 0.1, 0.5}; }, {}, "a speed that is 4 steps off at rest");
  expect_sound(
      [](double t) {
        return State{1.2, std::lround(t * 1e3) % 3 == 0 ? 2.0 : -1.0, 0.5};
      },
      {}, "noise at rest");
  expect_sound([](double t) { return swing(std::max(t, 0.25)); }, {},
               "rest at the end of the swing, then motion");
}

TEST(CanTraceMotion, AnAbruptStopWithALateSpeedIsNotDoubted) {
  expect_sound(
      [](double t) {
        const double moving_s = std::min(t, 0.2);
        return State{10.0 * moving_s - 1.0, t < 0.2 ? 10.0 : 10.0 * std::exp(-(t - 0.2) / 2e-3), 0.0};
      },
      {}, "a stop at 10 rad/s, the speed behind a low-pass of 2 ms");
}

TEST(CanTraceMotion, AFastMotionIsNotDoubted) {
  const auto fast = [](double t) {
    const double rate = 2.0 * std::numbers::pi * 8.0;
    return State{0.8 * std::sin(rate * t), 0.8 * rate * std::cos(rate * t), 0.0};
  };
  expect_sound(fast, {}, "40 rad/s");
  expect_sound(fast, {.batch = 5}, "40 rad/s, in batches of five replies");
  expect_sound(
      [&](double t) {
        return State{fast(t).position_rad, 0.6 * fast(t).velocity_radps, 0.0};
      },
      {}, "a velocity range that is wrong is a matter of the whole trace");
}

}  // namespace
}  // namespace sandhopper::trace
