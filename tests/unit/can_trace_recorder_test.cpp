#include <gmock/gmock.h>

#include "firmware/log/candump.hpp"
#include "tests/unit/can_trace_text.hpp"
#include "tools/trial/trace/recorder_loss.hpp"

// Traces whose recorder lost frames or wrote them in a form of its own.
namespace sandhopper::trace {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

TraceText sound(int exchanges = 20) {
  TraceText trace;
  for (int i = 0; i < exchanges; ++i) trace.command(i * kMs, 1).reply(i * kMs + kReply, 1);
  return trace;
}

TEST(CanTraceRecorder, ItsWordsOfLostFramesAreBelieved) {
  for (const char* line : {"DROPCOUNT: dropped 311 CAN frames on 'can0' socket (total drops 311)",
                           "DROPCOUNT: dropped 1 CAN frame on 'can0' socket (total drops 1)",
                           "candump: dropped 311 frames", "# 12 messages lost", "rx fifo overrun",
                           "WARNING: receive buffer overflow", "# frames lost: 7", "lost 5 packets"}) {
    auto trace = sound();
    const auto report = trace.raw(std::string(line) + "\n").report();
    EXPECT_THAT(text_of(report, "lost_by_recorder"), HasSubstr(std::string(line).substr(0, 20))) << line;
    EXPECT_FALSE(report.trusted()) << line;
  }
  EXPECT_EQ(loss_said_in("DROPCOUNT: dropped 311 CAN frames on 'can0' socket (total drops 900)")->frames,
            311U);
}

TEST(CanTraceRecorder, OtherLinesAreNoLoss) {
  for (const char* line : {"# 0 frames lost", "0 frames dropped", "Enabling Logfile 'candump.log'",
                           "# the drop test of frame B, from 0.2 m", "# lost the screw of the frame",
                           "interface = can0, bitrate = 1000000"}) {
    auto trace = sound();
    EXPECT_TRUE(trace.raw(std::string(line) + "\n").report().trusted()) << line;
  }
}

TEST(CanTraceRecorder, CanFdFramesOfAMotorAreNotThoseOfOtherNodes) {
  TraceText trace;
  for (int i = 0; i < 20; ++i) trace.command(i * kMs, 1).line(i * kMs + kReply, "011##10180007FF8384600");
  trace.line(0.1, "123##1AABB");
  const auto report = trace.report();
  EXPECT_THAT(text_of(report, "fd_frames_of_motors"),
              AllOf(HasSubstr("20 on 011 of motor left"), HasSubstr("sed 's/##[0-9A-Fa-f]/#/'")));
  EXPECT_THAT(text_of(report, "fd_frames"), HasSubstr("1 CAN FD frames of other nodes"));
  EXPECT_FALSE(report.trusted());
}

TEST(CanTraceRecorder, ATraceOfCanFdFramesAloneIsNamed) {
  TraceText trace;
  for (int i = 0; i < 20; ++i)
    trace.line(i * kMs, "001##180008000A3199800").line(i * kMs + kReply, "011##10180007FF8384600");
  const auto report = trace.report();
  EXPECT_EQ(report.fd_frames, 40U);
  EXPECT_THAT(text_of(report, "fd_frames_of_motors"), HasSubstr("20 on 001 of motor left"));
}

TEST(CanTraceRecorder, ExtendedIdentifiersOfTheMotorsNumbersAreNamed) {
  TraceText trace;
  for (int i = 0; i < 20; ++i)
    trace.line(i * kMs, "00000001#80008000A3199800").line(i * kMs + kReply, "00000011#0180007FF8384600");
  const auto report = trace.report();
  EXPECT_THAT(text_of(report, "extended_identifiers"),
              AllOf(HasSubstr("20 on 00000011 for 011 of motor left"), HasSubstr("sed -E")));
  EXPECT_FALSE(report.trusted());
  auto other = sound();
  EXPECT_TRUE(other.line(19.5 * kMs, "00000011#00").report().trusted()) << "a node of its own";
}

TEST(CanTraceRecorder, ExchangedIdentifiersOfRepliesAreNamedWithTheirCure) {
  TraceText trace;
  for (int i = 0; i < 20; ++i) {
    trace.command(i * kMs, 1).command(i * kMs + 0.1e-3, 2);
    trace.reply(i * kMs + kReply, 1, 0x8000, 0x12).reply(i * kMs + kReply + 0.1e-3, 2, 0x8000, 0x11);
  }
  const auto report = trace.report();
  EXPECT_THAT(
      text_of(report, "replies_elsewhere"),
      AllOf(HasSubstr("20 frames that begin with its number 01"), HasSubstr("come on 012"),
            HasSubstr("the two are exchanged: write master_id = 18 for motor left and master_id = 17")));
  CanReplaySetup cured;
  cured.config.motor[0].master_id = 18;
  cured.config.motor[1].master_id = 17;
  EXPECT_TRUE(trace.report(cured).trusted());
  EXPECT_EQ(trace.report(cured).decoded.size(), 40U);
}

TEST(CanTraceRecorder, MicrosecondsWithoutLeadingZerosAreNamed) {
  TraceText unpadded;
  for (int i = 0; i < 40; ++i) {
    unpadded.raw(fmt::format("(1700000000.{}) can0 001#80008000A3199800\n", i * 1000));
    unpadded.raw(fmt::format("(1700000000.{}) can0 011#0180007FF8384600\n", i * 1000 + 260));
  }
  const auto report = unpadded.report();
  EXPECT_THAT(text_of(report, "unpadded_times"),
              AllOf(HasSubstr("1 to 5 digits"), HasSubstr("microseconds"), HasSubstr("%06d")));
  EXPECT_THAT(kinds(report), Not(Contains("clock_step"))) << "a consequence";
  EXPECT_FALSE(report.trusted());
}

TEST(CanTraceRecorder, NumbersOfASpreadsheetAreNamed) {
  TraceText trace;
  for (int i = 0; i < 40; ++i) {
    trace.command(i * kMs, 1);
    if (i == 7 || i == 9)
      trace.line(i * kMs + kReply, i == 7 ? "011#0.00E+768348204100" : "011#1.80007E+14");
    else
      trace.reply(i * kMs + kReply, 1);
  }
  const auto report = trace.report();
  EXPECT_THAT(text_of(report, "spreadsheet_numbers"),
              AllOf(HasSubstr("in 2 lines a spreadsheet turned the data into a number"), HasSubstr("line 16"),
                    HasSubstr("import its columns as text")));
  EXPECT_THAT(kinds(report), Not(Contains("missed_replies"))) << "a consequence";
  EXPECT_FALSE(report.trusted());
  TraceText sound;
  for (int i = 0; i < 40; ++i) sound.command(i * kMs, 1).line(i * kMs + kReply, "011#010E00007FF84600");
  EXPECT_THAT(kinds(sound.report()), Not(Contains("spreadsheet_numbers")));
}

TEST(CanTraceRecorder, ATimeWithAMinusIsNotReadWithoutIt) {
  EXPECT_THROW(parse_candump("(-0.300000) can0 001#80008000A3199800"), CandumpError);
}

TEST(CanTraceRecorder, TimesWithoutTheirLastZerosAreRight) {
  TraceText trimmed;
  for (int i = 0; i < 40; ++i) {
    trimmed.raw(fmt::format("({}) can0 001#80008000A3199800\n", 1.5 + i * 1e-3));
    trimmed.raw(fmt::format("({}) can0 011#0180007FF8384600\n", 1.5 + i * 1e-3 + 0.26e-3));
  }
  EXPECT_TRUE(trimmed.report().trusted()) << ::testing::PrintToString(kinds(trimmed.report()));
}

}  // namespace
}  // namespace sandhopper::trace
