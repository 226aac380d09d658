#include <fmt/format.h>
#include <gmock/gmock.h>
#include <unistd.h>

#include <fstream>

#include "tests/unit/can_trace_text.hpp"
#include "tools/calibrate/foreign_table.hpp"

namespace sandhopper::calibrate {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

struct Read {
  std::size_t values = 0;
  std::string error, cure;
  std::vector<std::string> notes;
  double last_s = 0.0;
};

Read read_file(const std::filesystem::path& file, const std::string& column, const std::string& unit = {}) {
  try {
    const auto table = read_foreign_table(file, column, unit);
    const auto& signal = table.recording.signal;
    return {signal.value.size(), "", "", table.notes, signal.time_s.empty() ? 0.0 : signal.time_s.back()};
  } catch (const ForeignTableError& error) {
    return {0, error.what(), error.cure, {}, 0.0};
  }
}

Read read_text(const std::string& text, const std::string& unit = {}) {
  const auto file = std::filesystem::temp_directory_path() / fmt::format("foreign_{}.csv", ::getpid());
  std::ofstream(file) << text;
  auto read = read_file(file, "force", unit);
  std::filesystem::remove(file);
  return read;
}

std::string rows(const std::string& row, int count) {
  std::string text;
  for (int i = 0; i < count; ++i) text += fmt::format(fmt::runtime(row), i) + "\n";
  return text;
}

TEST(CalibrateTable, DecimalCommasAreReadOrNamed) {
  const auto file = trace::field_input("F07/foreign.csv");
  if (!file) GTEST_SKIP();
  const auto read = read_file(*file, "force");
  if (read.error.empty())
    EXPECT_EQ(read.values, 800U);
  else
    EXPECT_THAT(read.error, HasSubstr("decimal commas"));
}

TEST(CalibrateTable, DecimalCommasOfOtherFormsAreReadOrNamed) {
  for (const char* row : {"0,{:03};50,0", "0,{:03};-5,25", "0,{:03}\t+1,5"}) {
    const std::string text(row);
    const std::string separator = text.find(';') != std::string::npos ? ";" : "\t";
    const auto read = read_text("t_s" + separator + "force\n" + rows(text, 40));
    if (read.error.empty())
      EXPECT_EQ(read.values, 40U) << row;
    else
      EXPECT_THAT(read.error + read.cure, AllOf(HasSubstr("decimal commas"), HasSubstr("write points")))
          << row;
  }
}

TEST(CalibrateTable, AColumnWithoutNumbersIsSaidWithItsFirstCell) {
  const auto read = read_text("t_s,force\n" + rows("0.{:03},overload", 20));
  EXPECT_THAT(read.error, AllOf(HasSubstr("0 numbers of force in 20 rows"), HasSubstr("\"overload\"")));
}

TEST(CalibrateTable, AClockThatGoesBackIsSaidWithItsLine) {
  const auto slipped =
      read_text("t_s,force\n" + rows("1.{:03},1", 20) + "1.0185,1\n" + rows("1.1{:02},1", 20));
  EXPECT_THAT(slipped.error, HasSubstr(":22: its clock goes backwards"));
  const auto again = read_text("t_s,force\n" + rows("1.{:03},1", 20) + rows("0.5{:02},1", 20));
  EXPECT_THAT(again.error, AllOf(HasSubstr(":22: the time begins again"), HasSubstr("22 to 41")));
}

TEST(CalibrateTable, AFewBadCellsAreNotes) {
  const auto read = read_text("t_s,force\n" + rows("0.{:03},1", 20) + "0.9,oops\n");
  EXPECT_EQ(read.values, 20U);
  ASSERT_EQ(read.notes.size(), 1U);
  EXPECT_THAT(read.notes.front(), HasSubstr("\"oops\""));
}

TEST(CalibrateTable, TheUnitOfTheTimeIsThatOfTheUserOrOfTheLineOfUnits) {
  EXPECT_NEAR(read_text("t_s,force\n" + rows("1{:03}.5,1", 20), "ms").last_s, 1.0195, 1e-9);
  const auto stated = read_text("t_s,force\n(us),(N)\n" + rows("10{:02}000,1", 20));
  EXPECT_NEAR(stated.last_s, 1.019, 1e-9);
  ASSERT_EQ(stated.notes.size(), 1U);
  EXPECT_THAT(stated.notes.front(), HasSubstr("by the table's line of units"));
  EXPECT_NEAR(read_text("t_s,force\ns,N\n" + rows("1.{:03},1", 20)).last_s, 1.019, 1e-9);
}

TEST(CalibrateTable, MarksBetweenThousandsOfTheTimeAreNamedWithTheirRemoval) {
  const auto read = read_text("t_s;force\n" + rows("{0}.000;1.5", 900) + rows("1.{:03}.000;2.5", 950));
  EXPECT_THAT(read.error, AllOf(HasSubstr(":902: 950 times of t_s are no number and 900 are"),
                                HasSubstr("marks stand between thousands")));
  EXPECT_THAT(read.cure, HasSubstr("awk -F';' -v OFS=';' '{ gsub(/[.]/, \"\", $1) } 1'"));
  EXPECT_EQ(read_text("t_s;force\n" + rows("1{:03}000;2.5", 60), "us").values, 60U);
}

TEST(CalibrateTable, TimesWithTooFewDigitsAreNamed) {
  std::string text = "t_s,force\n";
  for (int i = 0; i < 200; ++i) text += fmt::format("{:.2f},1\n", 1e-3 * i);
  EXPECT_THAT(read_text(text).error, AllOf(HasSubstr("of 200 rows have the time of the row before"),
                                           HasSubstr("in steps of 0.01 only")));
  EXPECT_EQ(read_text("t_s,force\n" + rows("0.{:03},1", 50) + "0.049,1\n").values, 51U) << "one repeat";
}

TEST(CalibrateTable, RowsThatStandTwiceAreNamed) {
  std::string twice = "t_s,force\n", coarse = twice;
  for (int i = 0; i < 200; ++i) {
    for (int copy = 0; copy < 2; ++copy) twice += fmt::format("{:.3f},{}\n", 1e-3 * i, i % 7);
    coarse += fmt::format("{:.2f},{}\n", 1e-3 * i, i % 7);
  }
  const auto read = read_text(twice);
  EXPECT_THAT(read.error, AllOf(HasSubstr("200 of 400 rows are copies of the row before"),
                                HasSubstr("the rows stand twice")));
  EXPECT_THAT(read.cure, HasSubstr("uniq '"));
  EXPECT_THAT(read_text(coarse).error, ::testing::Not(HasSubstr("stand twice")));
}

TEST(CalibrateTable, NothingIsAskedForACampaignThatThereIsNot) {
  const auto read = read_text("t_s;force\n" + rows("{0};1,{0:03}", 40));
  for (const auto& note : read.notes) EXPECT_THAT(note, ::testing::Not(HasSubstr("campaign.toml")));
  EXPECT_THAT(read.error + read.cure, ::testing::Not(HasSubstr("campaign.toml")));
}

TEST(CalibrateTable, AMissingColumnIsSaidWithThoseThereAre) {
  EXPECT_THAT(read_text("time,force_N\n0,1\n").error, HasSubstr("it has time, force_N"));
}

}  // namespace
}  // namespace sandhopper::calibrate
