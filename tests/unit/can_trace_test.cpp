#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/can_trace_text.hpp"

namespace sandhopper::trace {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(CanTrace, CommandsWhoseFirstByteIsTheDrivesNumberAreNotReplies) {
  TraceText trace;
  for (int i = 0; i < 30; ++i)
    trace.command(i * kMs, 104, 0x6978U - 0x20U * static_cast<unsigned>(i))
        .reply(i * kMs + kReply, 104, 0x69AD);
  const auto report = trace.report(setup_of(104));
  EXPECT_EQ(report.decoded.size(), 30U);
  EXPECT_EQ(report.motors[0].commands, 30U);
  EXPECT_EQ(report.motors[0].missed, 0U);
  EXPECT_TRUE(report.trusted()) << ::testing::PrintToString(kinds(report));
}

TEST(CanTrace, NorAreTheyWhenASnifferMarksEveryFrameAsReceived) {
  TraceText trace;
  for (int i = 0; i < 20; ++i)
    trace.line(i * kMs, "068#68098000A3199800 R").line(i * kMs + kReply, "011#6868246668384600 R");
  const auto report = trace.report(setup_of(104));
  EXPECT_EQ(report.decoded.size(), 20U);
  EXPECT_EQ(report.motors[0].commands, 20U);
}

TEST(CanTrace, OnOneIdentifierAReplyFollowsItsCommand) {
  TraceText trace;
  for (int i = 0; i < 20; ++i) trace.command(i * kMs, 104, 0x6801).reply(i * kMs + kReply, 104, 0x6868, 104);
  const auto report = trace.report(setup_of(104));
  ASSERT_EQ(report.decoded.size(), 20U);
  EXPECT_EQ(report.motors[0].commands, 20U);
  for (const auto& decoded : report.decoded)
    EXPECT_NEAR(decoded.reading.sample.position_rad, -2.3, 0.1) << "0x6868 is -2.31 rad";
}

TEST(CanTrace, SetPointsAloneThatPassTheDrivesNumberGiveNoReply) {
  TraceText ramp, held;
  for (unsigned i = 0; i < 40; ++i) ramp.command(i * kMs, 104, 0x6A00 - 0x10 * i);
  for (int i = 0; i < 40; ++i) held.command(i * kMs, 104, 0x6810);
  EXPECT_TRUE(ramp.report(setup_of(104)).decoded.empty());
  const auto report = held.report(setup_of(104));
  EXPECT_TRUE(report.decoded.empty());
  EXPECT_FALSE(report.trusted());
  EXPECT_THAT(text_of(report, "ambiguous_frames"), HasSubstr("candump -L -x"));
}

TEST(CanTrace, TheDirectionOfEachFrameIsBelievedWhereSentOnesAreMarked) {
  TraceText trace;
  for (int i = 0; i < 20; ++i) trace.line(i * kMs, "068#68098000A3199800 T");
  for (int i = 0; i < 20; ++i) trace.line(0.1 + i * kMs, "068#6868246668384600 R");
  EXPECT_EQ(trace.report(setup_of(104)).decoded.size(), 20U);
}

TEST(CanTrace, UnansweredCommandsAreCountedWithTheirLongestGap) {
  TraceText trace;
  for (int i = 0; i < 60; ++i) {
    trace.command(i * kMs, 1);
    if (i != 10 && i != 30 && i != 31) trace.reply(i * kMs + kReply, 1);
  }
  const auto report = trace.report();
  EXPECT_EQ(report.motors[0].missed, 3U);
  EXPECT_EQ(report.motors[0].most_missed, 2U);
  EXPECT_NEAR(1e-9 * static_cast<double>(report.motors[0].longest_gap.length_ns), 3 * kMs, 1e-6);
  EXPECT_THAT(text_of(report, "missed_replies"), AllOf(HasSubstr("3 of 60"), HasSubstr("3 ms")));
  EXPECT_TRUE(report.trusted()) << "the robot bears two in a row";
}

TEST(CanTrace, AsManyMissesAsTheRobotCallsAFaultAreNotToBeTrusted) {
  TraceText trace;
  for (int i = 0; i < 60; ++i) {
    trace.command(i * kMs, 1);
    if (i < 30 || i > 32) trace.reply(i * kMs + kReply, 1);
  }
  const auto report = trace.report();
  EXPECT_EQ(report.motors[0].most_missed, 3U);
  EXPECT_FALSE(report.trusted());
  EXPECT_THAT(text_of(report, "missed_replies"), HasSubstr("limits.motor_reply_misses = 3"));
}

TEST(CanTrace, TheLastCommandMayBeAnsweredAfterTheEnd) {
  TraceText trace;
  for (int i = 0; i < 20; ++i) trace.command(i * kMs, 1).reply(i * kMs + kReply, 1);
  trace.command(20 * kMs, 1);
  EXPECT_EQ(trace.report().motors[0].missed, 0U);
}

TEST(CanTrace, ALateReplyIsLateAndNotMissing) {
  TraceText trace;
  for (int i = 0; i < 30; ++i) {
    trace.command(i * kMs, 1);
    if (i == 11) trace.reply(i * kMs + 0.03e-3, 1);
    if (i != 10) trace.reply(i * kMs + kReply, 1);
  }
  const auto report = trace.report();
  EXPECT_EQ(report.motors[0].missed, 0U);
  EXPECT_EQ(report.motors[0].late, 1U);
  EXPECT_NEAR(1e-9 * static_cast<double>(report.motors[0].latest_ns), 1.03e-3, 1e-6);
}

TEST(CanTrace, CopiesCountOnceWhateverTheirInterface) {
  for (const char* second : {"can0", "can1"}) {
    TraceText trace;
    for (int i = 0; i < 20; ++i)
      trace.command(i * kMs, 1)
          .reply(i * kMs + kReply, 1)
          .line(i * kMs + kReply, "011#0180007FF8384600", second);
    const auto report = trace.report();
    EXPECT_EQ(report.decoded.size(), 20U);
    EXPECT_EQ(report.motors[0].doubled, 20U);
    EXPECT_THAT(text_of(report, "doubled_replies"), HasSubstr("20 replies stand twice"));
    EXPECT_TRUE(report.trusted());
  }
}

TEST(CanTrace, EveryThirdReplyUnaskedIsTwoDrivesWithOneNumber) {
  TraceText trace;
  for (int i = 0; i < 30; ++i) {
    trace.command(i * kMs, 1).reply(i * kMs + kReply, 1);
    if (i % 3 == 0) trace.reply(i * kMs + 0.40e-3, 1, 0x9000);
  }
  const auto report = trace.report();
  EXPECT_EQ(report.motors[0].unasked, 10U);
  EXPECT_FALSE(report.trusted());
}

TEST(CanTrace, AnEchoOfACommandIsNotACommandOfItsOwn) {
  TraceText trace;
  for (int i = 0; i < 20; ++i)
    trace.command(i * kMs, 1).command(i * kMs + 0.14e-3, 1).reply(i * kMs + kReply, 1);
  const auto report = trace.report();
  EXPECT_EQ(report.motors[0].commands, 20U);
  EXPECT_EQ(report.motors[0].missed, 0U);
  EXPECT_EQ(report.motors[0].commands_twice, 20U);
}

TEST(CanTrace, ErrorFramesAreNamed) {
  TraceText trace;
  for (int i = 0; i < 20; ++i) trace.command(i * kMs, 1).reply(i * kMs + kReply, 1);
  auto warned = trace;
  warned.line(0.0195, "20000004#0008000000006000");
  EXPECT_EQ(warned.report().bus.kinds.at("error-warning"), 1U);
  EXPECT_TRUE(warned.report().trusted());
  trace.line(0.1, "20000004#0030000000008081").line(0.101, "20000040#0000000000000000");
  trace.line(0.102, "20000100#0000000000000000").line(0.103, "20000004#0001000000000000");
  const auto report = trace.report();
  EXPECT_EQ(report.bus.frames, 4U);
  EXPECT_THAT(text_of(report, "bus_off"),
              AllOf(HasSubstr("1 bus-off"), HasSubstr("1 error-passive"), HasSubstr("1 restarted"),
                    HasSubstr("1 receive overflow"), HasSubstr("128 sending, 129 receiving")));
  EXPECT_FALSE(report.trusted());
}

TEST(CanTrace, DriveFaultsHaveNames) {
  TraceText trace;
  for (int i = 0; i < 20; ++i) trace.command(i * kMs, 1).line(i * kMs + kReply, "011#0180007FF8384604");
  const auto report = trace.report();
  EXPECT_THAT(text_of(report, "drive_fault"),
              AllOf(HasSubstr("under-voltage (code 4)"), HasSubstr("20 of 20")));
  EXPECT_FALSE(report.trusted());
}

TEST(CanTrace, AZeroSetOnTheWayIsSaid) {
  TraceText trace;
  for (int i = 0; i < 20; ++i) trace.command(i * kMs, 1).reply(i * kMs + kReply, 1);
  trace.line(0.1, "001#FFFFFFFFFFFFFFFE");
  EXPECT_THAT(text_of(trace.report(), "zero_set"), HasSubstr("set 1 times"));
}

TEST(CanTrace, FramesOfOtherNodesAreCountedByIdentifier) {
  TraceText trace;
  for (int i = 0; i < 20; ++i) trace.command(i * kMs, 1).reply(i * kMs + kReply, 1);
  trace.line(0.1, "123#00").line(0.11, "123#00").line(0.12, "18FF1234#00").line(0.13, "080#R");
  const auto report = trace.report();
  EXPECT_THAT(text_of(report, "other_identifiers"),
              AllOf(HasSubstr("4 frames"), HasSubstr("123 (2)"), HasSubstr("18FF1234 (1)"),
                    HasSubstr("080 (remote) (1)")));
}

TEST(CanTrace, TheSameMotorOnTwoBusesIsNotMixed) {
  TraceText trace;
  for (int i = 0; i < 20; ++i) {
    trace.line(i * kMs, "001#80008000A3199800").line(i * kMs + kReply, "011#0180007FF8384600");
    trace.line(i * kMs + 0.1e-3, "001#90008000A3199800", "can1");
    trace.line(i * kMs + 0.36e-3, "011#0190007FF8384600", "can1");
  }
  EXPECT_THAT(text_of(trace.report(), "several_interfaces"), HasSubstr("--bus can0"));
  CanReplaySetup one;
  one.bus = "can1";
  const auto report = trace.report(one);
  EXPECT_EQ(report.decoded.size(), 20U);
  EXPECT_THAT(kinds(report), Not(Contains("several_interfaces")));
}

TEST(CanTrace, LinesThatAreNoFrameAreCountedAndATornEndIsNot) {
  TraceText trace;
  for (int i = 0; i < 20; ++i) trace.command(i * kMs, 1).reply(i * kMs + kReply, 1);
  auto torn = trace;
  torn.raw("(1700000000.0210");
  EXPECT_THAT(kinds(torn.report()), Contains("torn_end"));
  EXPECT_TRUE(torn.report().trusted());
  trace.raw("(1700000000.02 can0 0\n")
      .raw("(1700000000.03) can0 123##1AABB\n")
      .raw("# 7 frames lost: full\n");
  trace.command(21 * kMs, 1).reply(21 * kMs + kReply, 1);
  const auto report = trace.report();
  EXPECT_EQ(report.decoded.size(), 21U);
  EXPECT_THAT(text_of(report, "unreadable_lines"), AllOf(HasSubstr("1 lines"), HasSubstr("line 41")));
  EXPECT_THAT(text_of(report, "fd_frames"), HasSubstr("1 CAN FD"));
  EXPECT_THAT(text_of(report, "lost_by_recorder"), HasSubstr("7 frames"));
  EXPECT_FALSE(report.trusted());
}

TEST(CanTrace, ZeroBytesOfAPowerCutDoNotHideTheFrameBehindThem) {
  TraceText trace;
  for (int i = 0; i < 20; ++i) trace.command(i * kMs, 1).reply(i * kMs + kReply, 1);
  trace.raw(std::string(300, '\0')).command(20 * kMs, 1).reply(20 * kMs + kReply, 1);
  const auto report = trace.report();
  EXPECT_EQ(report.motors[0].commands, 21U);
  EXPECT_THAT(text_of(report, "zero_bytes"), HasSubstr("300 bytes"));
  EXPECT_FALSE(report.trusted());
}

TEST(CanTrace, LinesOfOtherProgramsBetweenTheFramesAreShown) {
  TraceText trace;
  trace.raw("# a comment\n\nEnabling Logfile 'candump.log'\n");
  for (int i = 0; i < 20; ++i) trace.command(i * kMs, 1).reply(i * kMs + kReply, 1);
  EXPECT_THAT(text_of(trace.report(), "other_lines"),
              AllOf(HasSubstr("1 lines"), HasSubstr("Enabling Logfile")));
}

}  // namespace
}  // namespace sandhopper::trace
