#include <gmock/gmock.h>

#include <cmath>

#include "tests/unit/can_trace_text.hpp"
#include "tools/trial/trace/speed_ratio.hpp"

namespace sandhopper::trace {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

unsigned code(double value, double range, unsigned most) {
  return static_cast<unsigned>(std::lround((value + range) / (2.0 * range) * most));
}

// A drive whose link swings with 12.6 rad/s and 4 Hz; its velocity field spans +-`range_radps`.
struct Drive {
  double range_radps = 50.0;
  double amplitude_rad = 0.5;
  double frequency_Hz = 4.0;
  double late_s = 0.0;       // every second reply reaches the recorder so much later
  double filter_s = 0.0;     // delay of the drive's speed
  double noise_radps = 0.0;  // alternates from reply to reply
  int temperature_code = 0x46;
};

TraceText trace_of(const Drive& drive, int replies = 100) {
  TraceText trace;
  for (int i = 0; i < replies; ++i) {
    const double t = i * kMs, rate = 2.0 * 3.14159265 * drive.frequency_Hz;
    const double position = drive.amplitude_rad * std::sin(rate * t);
    const double speed = drive.amplitude_rad * rate * std::cos(rate * (t - drive.filter_s)) +
                         (i % 2 == 0 ? drive.noise_radps : -drive.noise_radps);
    trace.command(t, 1);
    trace.line(t + kReply + (i % 2 == 0 ? 0.0 : drive.late_s),
               fmt::format("011#01{:04X}{:03X}800{:02X}00", code(position, 12.5, 65535),
                           code(speed, drive.range_radps, 4095), drive.temperature_code));
  }
  return trace;
}

TEST(CanTraceSpeed, AVelocityRangeThatIsNotTheDrivesIsNamed) {
  const auto report = trace_of({.range_radps = 30.0}).report();
  EXPECT_THAT(text_of(report, "velocity_range"),
              AllOf(HasSubstr("motor left: its velocity is 1.67 times the change of its position"),
                    HasSubstr("velocity_range_radps = 30? robot.toml has 50")));
  EXPECT_FALSE(report.trusted());
  const auto wider = trace_of({.range_radps = 76.0}).report();
  EXPECT_THAT(text_of(wider, "velocity_range"), HasSubstr("velocity_range_radps = 76"));
}

TEST(CanTraceSpeed, TheRangeOfTheMessageIsTheCure) {
  CanReplaySetup setup;
  setup.config.motor[0].velocity_range_radps = 30.0;
  EXPECT_TRUE(trace_of({.range_radps = 30.0}).report(setup).trusted());
}

TEST(CanTraceSpeed, ASoundDriveIsNotDoubted) {
  EXPECT_TRUE(trace_of({}).report().trusted());
  for (const Drive& drive : {Drive{.late_s = 0.5e-3}, Drive{.filter_s = 2e-3}, Drive{.noise_radps = 0.5},
                             Drive{.amplitude_rad = 0.01}, Drive{.frequency_Hz = 15.0, .filter_s = 1e-3},
                             Drive{.amplitude_rad = 0.0, .noise_radps = 2.0}})
    EXPECT_THAT(kinds(trace_of(drive).report()), Not(Contains("velocity_range")))
        << drive.amplitude_rad << " rad, " << drive.late_s << " s late, " << drive.noise_radps << " rad/s";
}

TEST(CanTraceSpeed, ATemperatureAtWhichTheRobotStopsIsNamed) {
  const auto hot = trace_of({.temperature_code = 0xFF}).report();
  EXPECT_THAT(text_of(hot, "motor_hot"),
              AllOf(HasSubstr("100 of 100 replies give more than limits.motor_temperature_C = 90"),
                    HasSubstr("up to 215 degrees C, first in line 2"), HasSubstr("temperature_offset_40")));
  EXPECT_FALSE(hot.trusted());
  EXPECT_TRUE(trace_of({.temperature_code = 40 + 89}).report().trusted());
  const auto none = trace_of({.temperature_code = 0}).report();
  EXPECT_THAT(text_of(none, "no_temperature"), HasSubstr("all 100 replies give -40 degrees C"));
  EXPECT_TRUE(none.trusted());
}

TEST(CanTraceSpeed, ATemperatureBelowFreezingIsNamed) {
  const auto raw = trace_of({.temperature_code = 25}).report();
  EXPECT_THAT(text_of(raw, "motor_below_freezing"),
              AllOf(HasSubstr("100 of 100 replies give a temperature below 0 degrees C, down to -15"),
                    HasSubstr("without the offset of 40 (25 degrees C)"), HasSubstr("\"temperature\"")));
  EXPECT_TRUE(raw.trusted());
  EXPECT_THAT(kinds(trace_of({.temperature_code = 40}).report()), Not(Contains("motor_below_freezing")));
  EXPECT_THAT(kinds(trace_of({.temperature_code = 0}).report()), Not(Contains("motor_below_freezing")));
}

}  // namespace
}  // namespace sandhopper::trace
