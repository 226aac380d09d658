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
};

Read read_file(const std::filesystem::path& file, const std::string& column) {
  try {
    const auto table = read_foreign_table(file, column);
    return {table.recording.signal.value.size(), "", "", table.notes};
  } catch (const ForeignTableError& error) {
    return {0, error.what(), error.cure, {}};
  }
}

Read read_text(const std::string& text) {
  const auto file = std::filesystem::temp_directory_path() / fmt::format("foreign_{}.csv", ::getpid());
  std::ofstream(file) << text;
  auto read = read_file(file, "force");
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

TEST(CalibrateTable, AMissingColumnIsSaidWithThoseThereAre) {
  EXPECT_THAT(read_text("time,force_N\n0,1\n").error, HasSubstr("it has time, force_N"));
}

}  // namespace
}  // namespace sandhopper::calibrate
