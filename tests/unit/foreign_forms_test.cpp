#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "campaign_folder.hpp"
#include "firmware/log/csv_cells.hpp"
#include "read_campaign.hpp"
#include "tools/campaign/campaign_draft.hpp"
#include "tools/campaign/cell_forms.hpp"

// Cells, files and tables in a form that is not read. Each is named with its cure, and a sound neighbour of
// the same kind is read without a message.
namespace sandhopper {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

double depth_mm(int i) { return 0.4 * i; }
double force_N(int i) { return 10.0 + 0.05 * i * i + 0.01 * std::sin(7.0 * i); }

std::string press(const std::string& head, const std::function<std::string(int)>& row, int rows = 80) {
  std::string text = head + "\n";
  for (int i = 0; i < rows; ++i) text += row(i) + "\n";
  return text;
}
Told read_press(const std::string& head, const std::function<std::string(int)>& row,
                const std::string& campaign = "") {
  return read_campaign("plant = \"intruder\"\n" + campaign, press(head, row));
}

// The answer of `hop campaign import`, or its refusal.
std::string imported(const std::string& text) {
  CampaignFolder folder;
  folder.write("a.csv", text);
  try {
    std::string told;
    for (const auto& line :
         draft_campaign({folder.path() / "a.csv"}, CampaignPlant::intruder, folder.path()).said)
      told += line + "\n";
    return told;
  } catch (const std::runtime_error& error) {
    return error.what();
  }
}

TEST(ForeignForms, ANumberInAnotherFormIsNamed) {
  for (const auto& [cell, name] : {std::pair{"[1.2]", "an array of one number"},
                                   std::pair{"[ 1.2]", "an array of one number"},
                                   std::pair{"(1.2,)", "an array of one number"},
                                   std::pair{"np.float64(-1.2)", "with its type as Python"},
                                   std::pair{"array([1.2e-3])", "with its type as Python"},
                                   std::pair{"[1.2 0.3]", "several numbers"},
                                   std::pair{"b'1.2'", "bytes as Python"},
                                   std::pair{"1.2+0j", "a complex number"},
                                   std::pair{"1.20\xC2\xB1"
                                             "0.01",
                                             "its uncertainty"},
                                   std::pair{"<0.5", "a bound"},
                                   std::pair{"~0.5", "about right"},
                                   std::pair{"1.2x10^-3", "power of ten"},
                                   std::pair{"1.2*10^3", "power of ten"},
                                   std::pair{"0x1000", "a hexadecimal number"},
                                   std::pair{"1 3/8", "a fraction"},
                                   std::pair{"12\xC2\xB0 30'", "degrees and minutes"},
                                   std::pair{"\xD9\xA1\xD9\xA2", "digits of another script"},
                                   std::pair{"- 1.2", "a blank in it"},
                                   std::pair{"\"\"1.2\"\"", "quotes within quotes"},
                                   std::pair{"F=1.2", "behind a name"},
                                   std::pair{"+1.2E0f", "type of the language C"},
                                   std::pair{"45.2 %", "per cent"},
                                   std::pair{"1.2*", "a mark behind it"},
                                   std::pair{"1,23 kN", "with \"kN\" behind it"},
                                   std::pair{"1.2e-3 V", "with \"V\" behind it"},
                                   std::pair{"N 1.2", "with \"N\" before it"},
                                   std::pair{"10:00:00;12", "drops frames"},
                                   std::pair{"11:59:59.0 a. m.", "words other than AM and PM"}}) {
    EXPECT_FALSE(number_in_cell(cell, {})) << cell;
    const auto form = form_of_cell(cell);
    ASSERT_TRUE(form) << cell;
    EXPECT_THAT(form->name, HasSubstr(name)) << cell;
    EXPECT_THAT(form->cure, Not(IsEmpty())) << cell;
  }
  for (const auto* cell : {"x", "", "N/A", "(0.16)", "Versuch", "[mm]"})
    EXPECT_FALSE(form_of_cell(cell)) << cell;
}

TEST(ForeignForms, ANumberThatASpreadsheetKeepsAsTextIsRead) {
  for (const auto* cell : {"=1.25", "=\"1.25\"", "'1.25", "'1.25'", "+1.25", "1.25", "1.25\xC2\xA0"})
    EXPECT_EQ(number_in_cell(cell, {}), 1.25) << cell;
  for (const auto* cell : {"=A1", "=1.2+3", "'", "=", "1'25'"})
    EXPECT_FALSE(number_in_cell(cell, {})) << cell;
}

TEST(ForeignForms, AColumnOfArraysIsNamedAndNoOtherColumnIsBlamed) {
  const auto told = read_press("t_s,force_N,foot_z_m", [](int i) {
    return fmt::format("{:.1f},[{:.4f}],[{:.5f}]", 0.1 * i, force_N(i), -1e-3 * depth_mm(i));
  });
  EXPECT_FALSE(told.recording.usable());
  EXPECT_THAT(told.text, HasSubstr("\"[10.0000]\" is not a number (and 79 more like it"));
  EXPECT_THAT(told.text, HasSubstr("an array of one number as Python prints it"));
  EXPECT_THAT(told.text, Not(HasSubstr("no column is a channel")));
}

TEST(ForeignForms, AFileThatWasNotFetchedIsNamed) {
  const std::string pointer = "version https://git-lfs.github.com/spec/v1\noid sha256:4d7a21\nsize 12345\n";
  EXPECT_THAT(imported(pointer), HasSubstr("a pointer of git LFS to the recording, which was not fetched"));
  EXPECT_THAT(imported(pointer), HasSubstr("git lfs pull"));
  EXPECT_THAT(read_campaign("plant = \"intruder\"", pointer).text, HasSubstr("git lfs pull"));
  EXPECT_THAT(imported("/annex/objects/MD5E-s100--d41d8c.csv\n"), HasSubstr("git annex get"));
  EXPECT_THAT(imported("outs:\n- md5: d41d8c\n  path: a.csv\n"), HasSubstr("dvc pull"));
  // A remark about the version above a table is no pointer.
  const auto sound = read_press("version 3 of the logger\nt_s,force_N,foot_z_m", [](int i) {
    return fmt::format("{:.1f},{:.4f},{:.5f}", 0.1 * i, force_N(i), -1e-3 * depth_mm(i));
  });
  EXPECT_TRUE(sound.recording.usable()) << sound.text;
}

TEST(ForeignForms, ChannelsInRowsAreNamed) {
  std::string time = "Time (s)", depth = "Depth (mm)", force = "Force (N)", numbers;
  for (int i = 0; i < 80; ++i) {
    time += fmt::format(",{:.1f}", 0.1 * i);
    depth += fmt::format(",{:.2f}", depth_mm(i));
    force += fmt::format(",{:.3f}", force_N(i));
    numbers += fmt::format(",{}", i);
  }
  const auto rows = time + "\n" + depth + "\n" + force + "\n";
  for (const auto& text : {rows, numbers + "\n" + rows}) {
    EXPECT_THAT(imported(text),
                HasSubstr("holds its channels one below the other (\"Time (s)\", \"Depth (mm)\""));
    EXPECT_THAT(imported(text), HasSubstr("csv.reader(open('FILE'), delimiter=',')"));
    EXPECT_THAT(read_campaign("plant = \"intruder\"", text).text, HasSubstr("exchange rows and columns"));
  }
  // A sensor's name before each row, and no line of names: not transposed.
  const auto labelled =
      press("", [](int i) { return fmt::format("FT1,{:.1f},{:.3f},{:.3f}", 0.1 * i, 1.0, 2.0); });
  EXPECT_THAT(imported(labelled), HasSubstr("no header"));
}

}  // namespace
}  // namespace sandhopper
