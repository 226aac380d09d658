#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/can_trace_text.hpp"

// CAN traces in the formats of laboratories, from the folder field_inputs beside this repository, each with
// its expected result.
namespace sandhopper::trace {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(FieldTraces, F02CommandsWithTheDrivesNumberInFrontAreNotDecoded) {
  const auto file = field_input("F02/trace.log");
  if (!file) GTEST_SKIP();
  const auto report = replay_can(*file, setup_of(104)).trace;
  EXPECT_EQ(report.decoded.size(), 30U);
  EXPECT_EQ(report.motors[0].commands, 30U);
  for (const auto& decoded : report.decoded) {
    EXPECT_EQ(decoded.frame.can_id, 0x11U);
    EXPECT_LT(decoded.reading.sample.position_rad, -2.15);
    EXPECT_GT(decoded.reading.sample.position_rad, -2.55);
  }
  EXPECT_TRUE(report.trusted());
}

TEST(FieldTraces, F08UnansweredCommandsAndErrorFramesAreCounted) {
  const auto file = field_input("F08/trace.log");
  if (!file) GTEST_SKIP();
  const auto report = replay_can(*file, setup_of(1)).trace;
  EXPECT_THAT(text_of(report, "missed_replies"), HasSubstr("6 of 30 commands unanswered"));
  EXPECT_THAT(text_of(report, "bus_off"),
              AllOf(HasSubstr("2 error frames"), HasSubstr("bus-off"), HasSubstr("error-passive")));
  EXPECT_FALSE(report.trusted());
}

TEST(FieldTraces, F08bDoubledRepliesAreCounted) {
  const auto file = field_input("F08b/trace.log");
  if (!file) GTEST_SKIP();
  const auto report = replay_can(*file, setup_of(1)).trace;
  EXPECT_EQ(report.decoded.size(), 20U);
  EXPECT_THAT(text_of(report, "doubled_replies"), HasSubstr("20 replies stand twice"));
}

TEST(FieldTraces, F14DrivesOfAnotherDialectAreNamed) {
  const auto file = field_input("F14/trace.log");
  if (!file) GTEST_SKIP();
  const auto report = replay_can(*file, setup_of(1)).trace;
  std::string all;
  for (const auto& finding : report.findings) all += finding.text + " -> " + finding.cure + "\n";
  EXPECT_THAT(all, AllOf(HasSubstr("drive 1 speaks servo or v3"), HasSubstr("drive 2 speaks servo or v3"),
                         HasSubstr("set dialect")));
  EXPECT_FALSE(report.trusted());
}

}  // namespace
}  // namespace sandhopper::trace
