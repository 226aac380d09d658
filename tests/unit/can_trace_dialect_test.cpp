#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/can_trace_text.hpp"
#include "tools/trial/trace/foreign_format.hpp"

namespace sandhopper::trace {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

CanReplaySetup dialect_of(Dialect dialect) {
  CanReplaySetup setup;
  for (auto& motor : setup.config.motor) motor.dialect = dialect;
  return setup;
}

TEST(CanTraceDialect, StatusFramesAreToldAsServoOrV3) {
  TraceText trace;
  for (int i = 0; i < 5; ++i) trace.line(i * 2 * kMs, "00002901#FE99000000401B00");
  EXPECT_THAT(
      text_of(trace.report(), "another_dialect"),
      AllOf(HasSubstr("drive 1"), HasSubstr("servo or v3"), HasSubstr("2901"), HasSubstr("set dialect")));
  auto v3 = trace;
  v3.line(0.1, "00000801#0006667FFF8F57FF");
  EXPECT_THAT(text_of(v3.report(), "another_dialect"), HasSubstr("dialect = \"v3\""));
  trace.line(0.1, "00000101#00000FA0");
  EXPECT_THAT(text_of(trace.report(), "another_dialect"), HasSubstr("dialect = \"servo\""));
}

TEST(CanTraceDialect, MitRepliesAreToldWhereServoIsConfigured) {
  TraceText trace;
  for (int i = 0; i < 20; ++i) trace.command(i * kMs, 1).reply(i * kMs + 0.26 * kMs, 1);
  const auto report = trace.report(dialect_of(Dialect::servo));
  EXPECT_TRUE(report.decoded.empty());
  EXPECT_THAT(text_of(report, "another_dialect"), AllOf(HasSubstr("speaks mit"), HasSubstr("\"servo\"")));
  EXPECT_FALSE(report.trusted());
}

TEST(CanTraceDialect, DrivesThatAreNotConfiguredAreNamed) {
  TraceText trace;
  for (int i = 0; i < 20; ++i) trace.command(i * kMs, 5).reply(i * kMs + 0.26 * kMs, 5, 0x8000, 0x15);
  const auto report = trace.report();
  EXPECT_THAT(text_of(report, "unknown_drives"),
              AllOf(HasSubstr("drive 5"), HasSubstr("015"), HasSubstr("1 and 2")));
  EXPECT_FALSE(report.trusted());
}

TEST(CanTraceDialect, V3CommandsPairWithTheirStatusFrames) {
  TraceText trace;
  for (int i = 0; i < 30; ++i) {
    trace.line(i * kMs, "00000801#0000007FFF7FF7FF");
    if (i != 7) trace.line(i * kMs + 0.3 * kMs, "00002901#FE99000000401B00");
  }
  const auto report = trace.report(dialect_of(Dialect::v3));
  EXPECT_EQ(report.decoded.size(), 29U);
  EXPECT_EQ(report.motors[0].commands, 30U);
  EXPECT_EQ(report.motors[0].missed, 1U);
  EXPECT_TRUE(report.trusted());
}

TEST(CanTraceDialect, AServoDrivesMissingStatusFramesAreCountedByTheirRate) {
  TraceText trace;
  for (int i = 0; i < 60; ++i)
    if (i != 20 && i != 21) trace.line(i * 2 * kMs, "00002901#FE99000000401B00");
  const auto report = trace.report(dialect_of(Dialect::servo));
  EXPECT_EQ(report.motors[0].missed, 2U);
  EXPECT_THAT(kinds(report), Not(Contains("unasked_replies")));
}

class Formats : public ::testing::Test {
 protected:
  std::optional<ForeignFormat> of(const std::string& text, const std::string& name = "my trace.txt") {
    const auto folder = std::filesystem::temp_directory_path() / fmt::format("formats_{}", ::getpid());
    std::filesystem::create_directories(folder);
    file_ = folder / name;
    std::ofstream(file_, std::ios::binary) << text;
    return recognise_format(file_);
  }
  // Runs the cure, a shell command, in the file's folder and returns the converted text.
  std::string converted(const ForeignFormat& format) {
    const auto folder = file_.parent_path();
    const auto command = fmt::format("cd '{}' && {}", folder.string(), format.cure);
    EXPECT_EQ(std::system(command.c_str()), 0) << command;  // NOLINT(concurrency-mt-unsafe)
    std::ifstream in(folder / "my trace.log");
    return {std::istreambuf_iterator<char>(in), {}};
  }
  std::filesystem::path file_;
};

constexpr const char* kOneFrame = "(1700000000.000260) can0 011#0180006668384600\n";

TEST_F(Formats, CandumpTextIsNotForeign) {
  EXPECT_FALSE(of(kOneFrame));
  EXPECT_FALSE(of("# a comment\n"));
}

TEST_F(Formats, CandumpWithoutLIsConvertedByTheLineGiven) {
  for (const char* text : {" (1700000000.000260)  can0  011   [8]  01 80 00 66 68 38 46 00\n",
                           " (1700000000.000260)  can0  RX - -  011   [8]  01 80 00 66 68 38 46 00\n",
                           " (1700000000.000260)  can0  011   [8]  01 80 00 66 68 38 46 00   '...fh8F.'\n",
                           "(1700000000.000260)  can0       011   [8]  01 80 00 66 68 38 46 00\n"}) {
    const auto format = of(text);
    ASSERT_TRUE(format) << text;
    EXPECT_EQ(converted(*format), kOneFrame) << text;
  }
}

TEST_F(Formats, BytesInTheOtherOrderAreTurnedByTheLineGiven) {
  const auto format =
      of(" (1700000000.000260)  can0  011   [8]  00`46`38`68`66`00`80`01\n"
         " (1700000000.001000)  can0  012   [2]  80`02\n"
         " (1700000000.002000)  can0  012   [1]  80\n");
  ASSERT_TRUE(format);
  EXPECT_EQ(converted(*format),
            std::string(kOneFrame) + "(1700000000.001000) can0 012#0280\n(1700000000.002000) can0 012#80\n");
}

TEST_F(Formats, ColoursOfATerminalAreRemovedByTheLineGiven) {
  const auto format = of("\x1b[1;31m (1700000000.000260)  can0  011   [8]  01 80 00 66 68 38 46 00\x1b[0m\n");
  ASSERT_TRUE(format);
  EXPECT_THAT(format->what, HasSubstr("colours of a terminal"));
  EXPECT_EQ(converted(*format), kOneFrame);
  const auto log = of("\x1b[1;31m(1700000000.000260) can0 011#0180006668384600\x1b[0m\n");
  ASSERT_TRUE(log);
  EXPECT_EQ(converted(*log), kOneFrame);
}

TEST_F(Formats, NegativeTimesBeginAtZeroAfterTheLineGiven) {
  const auto format =
      of("(-0.300000) can0 001#80008000A3199800\n(-0.000100) can0 011#00\n(0.700000) can0 001#01\n");
  ASSERT_TRUE(format);
  EXPECT_THAT(format->what, HasSubstr("negative times"));
  EXPECT_EQ(converted(*format),
            "(0.000000) can0 001#80008000A3199800\n(0.299900) can0 011#00\n(1.000000) can0 001#01\n");
}

TEST_F(Formats, LostLeadingZerosArePutBackByTheLineGiven) {
  const auto format = of("(1700000000.000260) can0 11#180006668384600\n(1700000000.001000) can0 1#0\n");
  ASSERT_TRUE(format);
  EXPECT_THAT(format->what, HasSubstr("as a spreadsheet saves it"));
  const auto line = format->cure.substr(format->cure.find("awk"));
  EXPECT_EQ(converted({"", line}),
            std::string(kOneFrame) + "(1700000000.001000) can0 001#0000000000000000\n");
  EXPECT_FALSE(of(std::string(kOneFrame) + kOneFrame + "(1700000000.001000) can0 1#80\n"))
      << "one damaged line";
}

TEST_F(Formats, ACommaInTheTimesIsConvertedByTheLineGiven) {
  const auto format = of("(1700000000,000260) can0 011#0180006668384600\n");
  ASSERT_TRUE(format);
  EXPECT_EQ(converted(*format), kOneFrame);
}

TEST_F(Formats, AnSlcanDumpIsConvertedByTheLineGiven) {
  const auto format = of("t011801800066683846000001\rT000000113018006EA5E\rt01100002\r");
  ASSERT_TRUE(format);
  EXPECT_EQ(converted(*format),
            "(0.001000) can0 011#0180006668384600\n(59.998000) can0 00000011#018006\n(60.002000) can0 011#\n")
      << "the milliseconds of a minute begin again";
}

TEST_F(Formats, PythonCansPrintedMessagesAreConvertedByTheLineGiven) {
  const auto format = of(
      "Timestamp: 1700000000.000260    ID: 011    S Rx                DL:  8    01 80 00 66 68 38 46 00     "
      "Channel: can0\n");
  ASSERT_TRUE(format);
  EXPECT_EQ(converted(*format), kOneFrame);
}

// A remote frame has no data: it must not become a data frame of length 0.
TEST_F(Formats, RemoteFdAndErrorFramesStayThemselvesInTheLineGiven) {
  const auto long_form =
      of(" (1700000000.000260)  can0  011   [8]  01 80 00 66 68 38 46 00\n"
         " (1700000000.001000)  can0  001   [0]  remote request\n"
         " (1700000000.002000)  can0  001   [8]  remote request\n"
         " (1700000000.003000)  can0  123  [12]  00 01 02 03 04 05 06 07 08 09 0A 0B\n"
         "DROPCOUNT: dropped 3 CAN frames on 'can0' socket (total drops 3)\n"
         " (1700000000.004000)  can0  20000004   [8]  00 08 00 00 00 00 60 00   ERRORFRAME\n");
  ASSERT_TRUE(long_form);
  EXPECT_EQ(converted(*long_form), std::string(kOneFrame) +
                                       "(1700000000.001000) can0 001#R0\n(1700000000.002000) can0 001#R8\n"
                                       "(1700000000.003000) can0 123##0000102030405060708090A0B\n"
                                       "# DROPCOUNT: dropped 3 CAN frames on 'can0' socket (total drops 3)\n"
                                       "(1700000000.004000) can0 20000004#0008000000006000\n");
  const auto printed = of(
      "Timestamp: 1700000000.000260    ID: 011    S Rx                DL:  8    01 80 00 66 68 38 46 00     "
      "Channel: can0\n"
      "Timestamp: 1700000000.001000    ID: 001    S Rx     R          DL:  8     Channel: can0\n"
      "Timestamp: 1700000000.002000    ID: 00002901    X Rx            DL:  2    01 fe     Channel: can0\n"
      "Timestamp: 1700000000.003000    ID: 00000004    X Rx   E        DL:  1    00     Channel: can0\n");
  ASSERT_TRUE(printed);
  EXPECT_EQ(converted(*printed), std::string(kOneFrame) +
                                     "(1700000000.001000) can0 001#R8\n(1700000000.002000) can0 "
                                     "00002901#01FE\n(1700000000.003000) can0 20000004#00\n");
}

TEST_F(Formats, Utf16IsConvertedByTheLineGiven) {
  std::string text = "\xff\xfe";
  for (const char* c = kOneFrame; *c != '\0'; ++c) text += std::string{*c, '\0'};
  const auto format = of(text);
  ASSERT_TRUE(format);
  EXPECT_EQ(converted(*format), kOneFrame);
}

TEST_F(Formats, OtherProgramsFilesAreNamedWithTheirConverter) {
  EXPECT_THAT(of("date Fri Nov 27 07:00:00 2026\nbase hex  timestamps absolute\n")->cure,
              HasSubstr("asc2log"));
  EXPECT_THAT(of("date Mon Dec 6 11:21:13 am 2021\nbase hex  no internal events logged\n")->cure,
              AllOf(HasSubstr("can.logconvert"), Not(HasSubstr("asc2log"))));
  EXPECT_THAT(of("LOGG\x90")->cure, HasSubstr("can.logconvert"));
  EXPECT_THAT(of(";$FILEVERSION=2.1\n")->what, HasSubstr("PEAK"));
  EXPECT_THAT(of("timestamp,arbitration_id,extended,remote,error,dlc,data\n")->what, HasSubstr("python-can"));
  EXPECT_THAT(of("Time Stamp,ID,Extended,Dir,Bus,LEN,D1\n")->what, HasSubstr("SavvyCAN"));
  EXPECT_THAT(of("  can0  011   [8]  01 80 00 66 68 38 46 00\n")->what, HasSubstr("without times"));
  EXPECT_THAT(of(std::string("\x89MCAP0\r\n"))->cure, HasSubstr("without --can"));
}

}  // namespace
}  // namespace sandhopper::trace
