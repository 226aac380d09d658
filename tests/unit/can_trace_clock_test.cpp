#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "tests/unit/can_trace_text.hpp"

namespace sandhopper::trace {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(CanTraceClock, AStepBackIsFoundWithItsSize) {
  TraceText trace;
  for (int i = 0; i < 20; ++i) trace.command(i * kMs, 1).reply(i * kMs + kReply, 1);
  for (int i = 20; i < 40; ++i) trace.command(i * kMs - 0.5, 1).reply(i * kMs + kReply - 0.5, 1);
  const auto report = trace.report();
  ASSERT_EQ(report.clock.steps_back.size(), 1U);
  EXPECT_EQ(report.clock.steps_back.front().line, 41U);
  EXPECT_THAT(text_of(report, "clock_step"), AllOf(HasSubstr("line 41"), HasSubstr("0.499 s")));
  EXPECT_EQ(report.motors[0].missed, 0U) << "a step is no lost reply";
  EXPECT_FALSE(report.trusted());
}

TEST(CanTraceClock, AClockSetForwardOrAPauseIsFound) {
  for (const double jump_s : {0.021, 3600.0, 1.7e9}) {
    TraceText trace(jump_s > 1e9 ? 10.0 : 1.7e9);
    for (int i = 0; i < 20; ++i) trace.command(i * kMs, 1).reply(i * kMs + kReply, 1);
    for (int i = 20; i < 40; ++i) trace.command(i * kMs + jump_s, 1).reply(i * kMs + kReply + jump_s, 1);
    const auto report = trace.report();
    EXPECT_EQ(report.clock.pauses.size(), 1U) << jump_s;
    EXPECT_THAT(text_of(report, "pause"), HasSubstr("clock was set forward"));
    EXPECT_FALSE(report.trusted());
  }
}

TEST(CanTraceClock, ASlowLoopIsNoPause) {
  TraceText trace;
  for (int i = 0; i < 40; ++i) trace.command(i * 50 * kMs, 1).reply(i * 50 * kMs + kReply, 1);
  EXPECT_THAT(kinds(trace.report()), Not(Contains("pause")));
}

TEST(CanTraceClock, SwappedFramesGoBackToTheirPlace) {
  TraceText trace;
  for (int i = 0; i < 20; ++i) {
    if (i % 5 == 2)
      trace.reply(i * kMs + kReply, 1).command(i * kMs, 1);
    else
      trace.command(i * kMs, 1).reply(i * kMs + kReply, 1);
  }
  const auto report = trace.report();
  EXPECT_EQ(report.clock.swapped, 4U);
  EXPECT_EQ(report.motors[0].missed, 0U);
  EXPECT_EQ(report.motors[0].unasked, 0U);
  EXPECT_TRUE(report.trusted());
}

TEST(CanTraceClock, EveryPairSwappedIsNotMistakenForTimeDifferences) {
  TraceText trace;
  for (int i = 0; i < 20; ++i) trace.reply(i * kMs + kReply, 1).command(i * kMs, 1);
  const auto report = trace.report();
  EXPECT_FALSE(report.clock.differences);
  EXPECT_EQ(report.clock.swapped, 20U);
}

TEST(CanTraceClock, TimesThatAreDifferencesAreNamed) {
  TraceText trace(0.0);
  for (int i = 0; i < 30; ++i) trace.command(0.74e-3, 1).reply(kReply, 1);
  const auto report = trace.report();
  EXPECT_TRUE(report.clock.differences);
  EXPECT_THAT(text_of(report, "times_are_differences"), HasSubstr("candump -L"));
  EXPECT_FALSE(report.trusted());
}

TEST(CanTraceClock, TimesTooCoarseForTheCommandsAreSaid) {
  TraceText trace;
  for (int i = 0; i < 40; ++i) trace.command(i * kMs, 1).reply(i * kMs, 1);
  EXPECT_THAT(text_of(trace.report(), "coarse_times"), HasSubstr("resolution of 1 ms"));
  EXPECT_TRUE(trace.report().trusted()) << "each command has a time of its own";
  TraceText coarser;
  for (unsigned i = 0; i < 400; ++i)
    coarser.command(i / 10 * 0.01, 1, 0x8000 + i).reply(i / 10 * 0.01, 1, 0x8000 + i);
  const auto report = coarser.report();
  const auto coarse = std::ranges::find(report.findings, std::string("coarse_times"), &Finding::kind);
  ASSERT_NE(coarse, report.findings.end());
  EXPECT_THAT(coarse->text, HasSubstr("resolution of 10 ms"));
  EXPECT_FALSE(coarse->trusted);
}

// Times in whole milliseconds; `wrap_s`: time after which they begin again.
TraceText wrapping(double wrap_s, double begin_s) {
  TraceText trace(0.0);
  for (int i = 0; i < 1200; ++i) {
    const double t = std::fmod(begin_s + i * kMs, wrap_s);
    trace.command(t, 1).line(t, fmt::format("011#01{:04X}80F8004600", 0x8000 + i));
  }
  return trace;
}

TEST(CanTraceClock, ACounterThatBeginsAgainIsNoClockThatWasSetBack) {
  const auto report = wrapping(60.0, 59.4).report();
  EXPECT_THAT(
      text_of(report, "clock_wraps"),
      AllOf(HasSubstr("begin again after 60 s"), HasSubstr("line 1201 (59.999 s)"), HasSubstr("w += 60;")));
  EXPECT_THAT(kinds(report), Not(Contains("clock_step")));
  for (const auto& finding : report.findings) EXPECT_THAT(finding.text, Not(HasSubstr("nan")));
  EXPECT_THAT(kinds(report), Not(Contains("frozen_replies")));
  EXPECT_TRUE(wrapping(70.0, 59.4).report().trusted());
  EXPECT_THAT(kinds(wrapping(60.1, 59.6).report()),
              AllOf(Contains("clock_step"), Not(Contains("clock_wraps"))));
}

TEST(CanTraceClock, TheLineForACounterThatBeginsAgainGivesASoundTrace) {
  const auto folder = std::filesystem::temp_directory_path() / fmt::format("wraps_{}", ::getpid());
  std::filesystem::create_directories(folder);
  const auto file = folder / "trace.log";
  std::ofstream(file) << wrapping(60.0, 59.4).text();
  const auto report = replay_can(file, {}).trace;
  const auto cure = text_of(report, "clock_wraps");
  ASSERT_NE(cure.find("awk"), std::string::npos);
  const auto command = fmt::format("cd '{}' && {}", folder.string(), cure.substr(cure.find("awk")));
  ASSERT_EQ(std::system(command.c_str()), 0) << command;  // NOLINT(concurrency-mt-unsafe)
  const auto unwrapped = replay_can(folder / "unwrapped.log", {}).trace;
  EXPECT_TRUE(unwrapped.trusted()) << ::testing::PrintToString(kinds(unwrapped));
  EXPECT_EQ(unwrapped.decoded.size(), 1200U);
  std::filesystem::remove_all(folder);
}

TEST(CanTraceClock, FramesOfTwoClocksAreToldAsThat) {
  TraceText trace;
  for (int i = 0; i < 20; ++i) trace.command(i * kMs, 1).reply(i * kMs + kReply - 6.0, 1);
  EXPECT_THAT(text_of(trace.report(), "several_clocks"), HasSubstr("of several clocks"));
}

TEST(CanTraceClock, AFullSecondAsOldAsc2logWritesItIsNoTenth) {
  TraceText trace;
  for (int i = 0; i < 20; ++i) trace.command(0.980 + i * kMs, 1).reply(0.980 + i * kMs + kReply, 1);
  trace.raw("(1700000000.1000000) can0 001#80008000A3199800\n").reply(1.0 + kReply, 1);
  for (int i = 21; i < 40; ++i) trace.command(0.980 + i * kMs, 1).reply(0.980 + i * kMs + kReply, 1);
  const auto report = trace.report();
  EXPECT_TRUE(report.clock.steps_back.empty());
  EXPECT_EQ(report.motors[0].missed, 0U);
}

TEST(CanTraceClock, ATraceThatBeginsWithinAnExchangeHasNoUnaskedReply) {
  TraceText trace;
  trace.reply(kReply - kMs, 1);
  for (int i = 0; i < 40; ++i) trace.command(i * kMs, 1).reply(i * kMs + kReply, 1);
  const auto report = trace.report();
  EXPECT_EQ(report.motors[0].unasked, 0U);
  EXPECT_TRUE(report.trusted());
  TraceText twice;
  twice.reply(kReply - 2 * kMs, 1).reply(kReply - kMs, 1);
  for (int i = 0; i < 40; ++i) twice.command(i * kMs, 1).reply(i * kMs + kReply, 1);
  EXPECT_EQ(twice.report().motors[0].unasked, 1U);
}

TEST(CanTraceClock, RepliesThatAreStampedBeforeTheirCommandsAreSaid) {
  TraceText trace;
  for (int i = 0; i < 40; ++i) trace.reply(i * kMs - 0.37e-3, 1).command(i * kMs, 1);
  const auto report = trace.report();
  EXPECT_THAT(text_of(report, "late_replies"), HasSubstr("stamped before their own commands"));
  EXPECT_THAT(text_of(report, "unasked_replies"), Not(HasSubstr("came unasked")));
  EXPECT_FALSE(report.trusted());
}

}  // namespace
}  // namespace sandhopper::trace
