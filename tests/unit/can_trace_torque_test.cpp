#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "drivers/can/mit_protocol.hpp"
#include "tests/unit/can_trace_text.hpp"

namespace sandhopper::trace {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

// A drive that swings under a varying torque and reports `scale` times the torque that it is asked for.
struct Drive {
  double scale = 1.0;
  double torque_Nm = 1.5;  // amplitude of the feed-forward torque
  double kp = 0.0, kd = 0.0;
  double limit_Nm = 100.0;  // of the drive
  double noise_Nm = 0.0;    // alternates from reply to reply
  int late = 0;             // the torque is that of so many commands before
};

std::string hex(const MitPayload& payload) {
  std::string text;
  for (const auto byte : payload) text += fmt::format("{:02X}", byte);
  return text;
}

TraceText trace_of(const Drive& drive) {
  constexpr int kReplies = 600;
  TraceText trace;
  std::vector<double> asked;
  for (int i = 0; i < kReplies; ++i) {
    const double t = i * kMs, phase = 6.0 * 2.0 * 3.14159265 * t;
    const double position = 0.3 * std::sin(phase / 2.0), speed = 0.15 * 37.7 * std::cos(phase / 2.0);
    const double torque = drive.torque_Nm * std::sin(phase);
    trace.line(t, "001#" + hex(pack_mit_command({}, {0.1, 0.0, drive.kp, drive.kd, torque})));
    asked.push_back(drive.kp * (0.1 - position) - drive.kd * speed + torque);
    const double given = asked[static_cast<std::size_t>(std::max(0, i - drive.late))];
    const double reported = drive.scale * std::clamp(given, -drive.limit_Nm, drive.limit_Nm) +
                            (i % 2 == 0 ? drive.noise_Nm : -drive.noise_Nm);
    trace.line(t + kReply, "011#" + hex(pack_mit_reply({}, ReplyFlavour::temperature_offset_40,
                                                       {1, position, speed, reported, 30.0})));
  }
  return trace;
}

TEST(CanTraceTorque, AScaleThatIsNotThatOfTheCommandsIsNamed) {
  const auto report = trace_of({.scale = 0.72}).report();
  EXPECT_THAT(text_of(report, "torque_range"),
              AllOf(HasSubstr("motor left: the torque of its replies is 0.72 times that of its commands"),
                    HasSubstr("likely its replies span 25 Nm, robot.toml has torque_range_Nm = 18")));
  EXPECT_FALSE(report.trusted());
  EXPECT_THAT(text_of(trace_of({.scale = 0.125}).report(), "torque_range"), HasSubstr("is 0.125 times"));
  EXPECT_THAT(text_of(trace_of({.scale = 1.4}).report(), "torque_range"), HasSubstr("is 1.4 times"));
}

TEST(CanTraceTorque, TheTorqueOfTheGainsCounts) {
  const Drive gains{.scale = 0.72, .torque_Nm = 0.0, .kp = 20.0, .kd = 0.5};
  EXPECT_THAT(text_of(trace_of(gains).report(), "torque_range"), HasSubstr("is 0.72"));
}

TEST(CanTraceTorque, ASoundDriveIsNotDoubted) {
  for (const Drive& drive :
       {Drive{}, Drive{.kp = 20.0, .kd = 0.5}, Drive{.torque_Nm = 0.0, .kp = 20.0}, Drive{.noise_Nm = 1.0},
        Drive{.late = 1}, Drive{.late = 20}, Drive{.limit_Nm = 0.9}, Drive{.scale = 0.5, .torque_Nm = 0.05},
        Drive{.scale = 0.0}, Drive{.scale = 0.93}})
    EXPECT_THAT(kinds(trace_of(drive).report()), Not(Contains("torque_range")))
        << drive.scale << ", " << drive.kp << ", " << drive.noise_Nm << ", " << drive.late << ", "
        << drive.limit_Nm;
  EXPECT_TRUE(trace_of({}).report().trusted());
}

}  // namespace
}  // namespace sandhopper::trace
