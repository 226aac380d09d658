#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "campaign_folder.hpp"
#include "tools/campaign/cell_cures.hpp"
#include "tools/campaign/trial_recording.hpp"

// Facts that only the text of a table shows. Each test follows the cure of the message, and reads a sound
// neighbour that must not be flagged.
namespace sandhopper {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TrialRecording read(const std::string& bytes, const std::string& campaign) {
  CampaignFolder folder;
  folder.write("campaign.toml", "plant = \"intruder\"\n" + campaign).write("a.csv", bytes);
  const auto read = load_campaign(folder.path());
  return read_trial(read, read.trials.at(0));
}
TrialRecording read_with(const std::string& bytes, const std::string& columns,
                         const std::string& trial = "") {
  return read(bytes, columns + "\n[[trial]]\nfile = \"a.csv\"\n" + trial + "\n");
}

std::string told(const TrialRecording& recording) {
  std::string text;
  for (const auto& finding : recording.findings) text += to_string(finding) + "\n";
  return text;
}

double force_N(int i) { return 10.0 + 0.05 * i * i + 0.01 * std::sin(7.0 * i); }

// Rows first to last of a press: 0.4 mm deeper every 0.1 s; force times `factor`.
std::string rows(int first, int last, double factor = 1.0) {
  std::string text;
  for (int i = first; i <= last; ++i)
    text += fmt::format("{:.1f},{:.5f},{:.5f}\n", 0.1 * i, factor * force_N(i), -4e-4 * i);
  return text;
}

constexpr const char* kForce = "[columns]\nforce_N = \"Force (N)\"\n";

TEST(ForeignText, NamesWithAnotherUnitInMidFileAreRefused) {
  const auto text =
      "t_s,Force (N),foot_z_m\n" + rows(0, 89) + "t_s,Force (kN),foot_z_m\n" + rows(90, 150, 1e-3);
  const auto both = read_with(text, kForce);
  EXPECT_FALSE(both.usable());
  EXPECT_THAT(told(both),
              HasSubstr("line 92 names the columns again, and otherwise (\"Force (kN)\" for \"Force "
                        "(N)\")"));
  EXPECT_THAT(told(both), HasSubstr("select = { to_line = 91 }"));
  EXPECT_THAT(told(both), HasSubstr("format = { header_line = 92 } and select = { from_line = 93 }"));
  const auto first = read_with(text, kForce, "select = { to_line = 91 }");
  ASSERT_TRUE(first.usable()) << told(first);
  EXPECT_EQ(first.rows(), 90U);
  const auto second = read_with(text, kForce,
                                "format = { header_line = 92 }\nselect = { from_line = 93 }\n"
                                "columns = { force_N = { column = \"Force (kN)\", unit = \"kN\" } }");
  ASSERT_TRUE(second.usable()) << told(second);
  EXPECT_NEAR(second.channel("force_N").front(), force_N(90), 0.01);
}

TEST(ForeignText, TheCureForNamesInMidFileWorksFarDownInAFile) {
  const auto text = "t_s,force_N,foot_z_m\n" + rows(0, 599) + "t_s,foot_z_m,force_N\n";
  std::string exchanged;
  for (int i = 600; i < 700; ++i)
    exchanged += fmt::format("{:.1f},{:.5f},{:.5f}\n", 0.1 * i, -4e-4 * i, force_N(i));
  const auto both = read_with(text + exchanged, "");
  EXPECT_FALSE(both.usable());
  EXPECT_THAT(told(both), HasSubstr("line 602 names the columns again, and otherwise"));
  const auto second =
      read_with(text + exchanged, "", "format = { header_line = 602 }\nselect = { from_line = 603 }");
  ASSERT_TRUE(second.usable()) << told(second);
  EXPECT_EQ(second.rows(), 100U);
  EXPECT_NEAR(second.channel("force_N").front(), force_N(600), 1e-4);
}

TEST(ForeignText, ATrialBelowOtherNamesIsRefused) {
  const auto text =
      "t_s,Force (N),foot_z_m\n" + rows(0, 89) + "t_s,Force (kN),foot_z_m\n" + rows(90, 150, 1e-3);
  const auto second = read_with(text, kForce, "select = { from_line = 93 }");
  EXPECT_FALSE(second.usable());
  EXPECT_THAT(told(second),
              HasSubstr("this trial's rows stand below it; give this trial format = { header_line = "
                        "92 } and columns of its own"));
}

TEST(ForeignText, NamesInARemarkAreNamesToo) {
  const auto both = read_with(
      "t_s,Force (N),foot_z_m\n" + rows(0, 89) + "# t_s,Force (kN),foot_z_m\n" + rows(90, 150, 1e-3), kForce);
  EXPECT_FALSE(both.usable());
  EXPECT_THAT(told(both), HasSubstr("line 92 names the columns again"));
}

TEST(ForeignText, TheSameNamesAgainAndAChangeInAnUnusedColumnAreHarmless) {
  const std::string names = "t_s,Force (N),foot_z_m\n";
  const auto same = read_with(names + rows(0, 89) + names + rows(90, 150), kForce);
  EXPECT_TRUE(same.usable()) << told(same);
  const auto units =
      read_with("t_s,Force,foot_z_m\ns,N,m\n" + rows(0, 89) + "t_s,Force,foot_z_m\ns,N,m\n" + rows(90, 150),
                "[columns]\nforce_N = \"Force\"\n");
  EXPECT_TRUE(units.usable()) << told(units);
  const auto joined = read_with(names + rows(0, 89) + "\xEF\xBB\xBF" + names + rows(90, 150), kForce);
  EXPECT_TRUE(joined.usable()) << told(joined);
  const auto blanks = read_with(
      "t_s,Force (N),foot_z_m\n" + rows(0, 89) + "t_s,Force(N),foot_z_m\n# N\nmm\n" + rows(90, 150), kForce);
  EXPECT_TRUE(blanks.usable()) << told(blanks);
  std::string other = "t_s,force_N,foot_z_m,Remark A\n";
  for (int i = 0; i < 60; ++i) {
    if (i == 30) other += "t_s,force_N,foot_z_m,Remark B\n";
    other += fmt::format("{:.1f},{:.4f},{:.5f},{}\n", 0.1 * i, force_N(i), -4e-4 * i, i);
  }
  const auto unused = read_with(other, "");
  EXPECT_TRUE(unused.usable()) << told(unused);
}

TEST(ForeignText, OtherUnitsInALineOfUnitsInMidFileAreRefused) {
  const auto text =
      "t_s,Force,foot_z_m\ns,N,m\n" + rows(0, 89) + "t_s,Force,foot_z_m\ns,kN,m\n" + rows(90, 150, 1e-3);
  const auto both = read_with(text, "[columns]\nforce_N = \"Force\"\n");
  EXPECT_FALSE(both.usable());
  EXPECT_THAT(told(both), HasSubstr("line 94 states the units again, and otherwise (\"kN\" for \"N\")"));
}

std::string in_groups(double value, char mark) {
  auto digits = fmt::format("{:.0f}", value);
  if (value >= 1000) digits.insert(digits.size() - 3, 1, mark);
  return digits;
}

TEST(ForeignText, WholeNumbersWithAMarkBetweenThousandsAreAsked) {
  for (const char mark : {'.', ','}) {
    std::string text = "t_s;F (mN);z (um)\n";
    for (int i = 0; i < 60; ++i)
      text += fmt::format("{};{};{}\n", i, in_groups(200 + 90 * i, mark), in_groups(10 + 50 * i, mark));
    const std::string columns =
        "[columns]\nforce_N = { column = \"F (mN)\", unit = \"mN\" }\nfoot_z_m = { column = \"z (um)\", "
        "scale = "
        "-1e-6 }\n";
    const auto asked = read_with(text, columns);
    EXPECT_FALSE(asked.usable()) << mark;
    EXPECT_THAT(told(asked), HasSubstr(fmt::format("thousands = \"{}\"", mark)));
    const auto cured = read_with(text, columns + fmt::format("[format]\nthousands = \"{}\"\n", mark));
    ASSERT_TRUE(cured.usable()) << told(cured);
    EXPECT_NEAR(cured.channel("force_N")[20], 2.0, 1e-9);
    EXPECT_NEAR(cured.channel("foot_z_m")[40], -2010e-6, 1e-12);
  }
}

TEST(ForeignText, AMillionShowsWhatTheMarkOfTheThousandsIs) {
  std::string text = "t_s;force_N;foot_z_m\n";
  for (int i = 0; i < 60; ++i)
    text += fmt::format("{};{};{:.5f}\n", i, i < 57 ? fmt::format("{}.500", 10 + i) : "1.000.500", -4e-4 * i);
  const auto asked = read_with(text, "");
  EXPECT_FALSE(asked.usable());
  EXPECT_THAT(told(asked), HasSubstr("\"10.500\" may be 10500 or 10.500"));
}

TEST(ForeignText, DecimalsAreNotAsked) {
  const auto usable = [](const std::function<std::string(int)>& force) {
    std::string text = "t_s;force_N;foot_z_m\n";
    for (int i = 0; i < 60; ++i) text += fmt::format("{};{};{:.5f}\n", i, force(i), -4e-4 * i);
    const auto recording = read_with(text, "");
    EXPECT_TRUE(recording.usable()) << told(recording);
  };
  usable([](int i) { return fmt::format("{:.3f}", 4.0 + 0.37 * i); });        // a mark in every cell
  usable([](int i) { return fmt::format("{}", (4000 + 37 * i) / 1000.0); });  // without final zeros
  usable(
      [](int i) { return i % 2 == 0 ? "1500" : fmt::format("{:.3f}", 4.37 * i + 1); });  // 1500 has no mark
  usable([](int i) { return i == 0 ? "0" : fmt::format("{:.3f}", 0.137 * i); });         // 0.137
}

TEST(ForeignText, UnitsThatChangeByRowAreRefusedAndOneUnitIsTaken) {
  const auto with = [](double factor, const char* other, const std::string& mapping) {
    std::string text = "t_s,Force,Unit,foot_z_m\n";
    for (int i = 0; i < 80; ++i)
      text += fmt::format("{:.1f},{:.5f},{},{:.5f}\n", 0.1 * i, force_N(i) * (i < 40 ? 1e-3 : factor),
                          i < 40 ? "kN" : other, -4e-4 * i);
    return read_with(text, "[columns]\nforce_N = " + mapping + "\n");
  };
  const auto mixed = with(1.0, "N", "{ column = \"Force\", unit = \"N\", scale = 1.0 }");
  EXPECT_FALSE(mixed.usable());
  EXPECT_THAT(told(mixed),
              HasSubstr("the column \"Unit\" holds units that change from row to row, kN from line 2 and "
                        "N from line 42"));
  const auto plain = with(1e-3, "kN", "\"Force\"");
  EXPECT_FALSE(plain.usable());
  EXPECT_THAT(told(plain), HasSubstr("the column \"Unit\" says \"kN\", which does not fit scale = 1 to N"));
  const auto cured = with(1e-3, "kN", "{ column = \"Force\", unit = \"kN\" }");
  ASSERT_TRUE(cured.usable()) << told(cured);
  EXPECT_NEAR(cured.channel("force_N")[20], force_N(20), 0.01);
}

TEST(ForeignText, UnitsAboveTheNamesAreComparedWithTheMapping) {
  const auto with = [](const std::string& above, const std::string& columns) {
    return read_with(above + "t_s,Force,z\n" + rows(0, 79, 1e-3), "[columns]\n" + columns);
  };
  const std::string depth = "foot_z_m = \"z\"\n";
  const auto asked = with("Force unit: kN\n", depth + "force_N = \"Force\"\n");
  EXPECT_FALSE(asked.usable());
  EXPECT_THAT(told(asked),
              HasSubstr("line 1, \"Force unit: kN\", says \"kN\", which does not fit scale = 1 to N"));
  const auto cured =
      with("Force unit: kN\n", depth + "force_N = { column = \"Force\", unit = \"kN\", scale = 1000 }\n");
  ASSERT_TRUE(cured.usable()) << told(cured);
  EXPECT_NEAR(cured.channel("force_N")[20], force_N(20), 0.01);
  const auto listed = with("# units: s; kN; m\n", depth + "force_N = \"Force\"\n");
  EXPECT_FALSE(listed.usable()) << told(listed);
  for (const auto* key : {"ForceUnit=kN\n", "X_Unit_Label,s\nY_Unit_Label,kN\n", "Einheit Kraft: kN\n"}) {
    const auto keyed = with(key, depth + "force_N = \"Force\"\n");
    EXPECT_FALSE(keyed.usable()) << key << told(keyed);
  }
  const auto fits = with("Force units: N\nLength units: m\nThe unit was set up by Ann in May\n",
                         depth + "force_N = \"Force\"\n");
  EXPECT_TRUE(fits.usable()) << told(fits);
}

TEST(ForeignText, TimesWithACountBehindThePointAreNamed) {
  const auto at_ms = [](int step_ms, const char* format) {
    std::string text = "t_s,force_N,foot_z_m\n";
    for (int i = 0; i < 80; ++i)
      text += fmt::format(fmt::runtime(format), 100 + step_ms * i / 1000, step_ms * i % 1000) +
              fmt::format(",{:.4f},{:.5f}\n", force_N(i), -4e-4 * i);
    return read_with(text, "");
  };
  const auto bare = at_ms(30, "{}.{}");
  EXPECT_FALSE(bare.usable());
  EXPECT_THAT(told(bare), HasSubstr("100.120 follows 100.90: the digits behind the \".\" are a count"));
  EXPECT_THAT(told(bare), Not(HasSubstr("several recordings")));
  const auto padded = at_ms(30, "{}.{:03}");
  ASSERT_TRUE(padded.usable()) << told(padded);
  EXPECT_NEAR(padded.t_s[10] - padded.t_s[0], 0.3, 1e-9);
}

TEST(ForeignText, RowsInTheOrderOfTheAlphabetAreNamed) {
  std::vector<std::string> lines;
  for (int i = 0; i < 120; ++i) lines.push_back(fmt::format("{},{:.4f},{:.5f}", i, force_N(i), -4e-4 * i));
  std::ranges::sort(lines);
  const auto sorted = read_with(fmt::format("t_s,force_N,foot_z_m\n{}\n", fmt::join(lines, "\n")), "");
  EXPECT_FALSE(sorted.usable());
  EXPECT_THAT(told(sorted), HasSubstr("sorted as text and not as numbers"));
  const auto twice = read_with("t_s,force_N,foot_z_m\n" + rows(0, 40) + rows(3, 40), "");
  EXPECT_THAT(told(twice), HasSubstr("several recordings"));
}

TEST(ForeignText, ACellThatIsNoNumberHasTheCureOfItsKind) {
  for (const auto& [cell, cure] :
       {std::pair{"0,16-", "decimal = \",\""}, std::pair{"(0.16)", "brackets mean a negative number"},
        std::pair{"1,00,000", "Indian way"}, std::pair{"12,34,567.5", "Indian way"},
        std::pair{"1,234,567", "thousands = \",\""}, std::pair{"1,000", "thousands = \",\""},
        std::pair{"1,5", "decimal = \",\""}, std::pair{"12 N", "write the unit into"},
        std::pair{"x", "leave the cell"}}) {
    const CsvIssue issue{.text = fmt::format("\"{}\" is not a number", cell),
                         .fault = CsvFault::not_a_number};
    EXPECT_THAT(cure_for_cells(issue, ';'), HasSubstr(cure)) << cell;
  }
}

TEST(ForeignText, CommasBetweenCommasAreNoDecimalCommas) {
  const CsvIssue issue{.text = "\"1,000\" is not a number", .fault = CsvFault::not_a_number};
  EXPECT_THAT(cure_for_cells(issue, ','), Not(HasSubstr("decimal")));
}

TEST(ForeignText, BytesThatWindows1252DoesNotHaveAreNamed) {
  const auto with = [](const std::string& name) {
    return read_with(name + ",force_N,foot_z_m\n" + rows(0, 79), "", "format = { row_every_s = 0.1 }");
  };
  const auto japanese = with("\x89\xD7\x8F\x64");
  EXPECT_FALSE(japanese.usable());
  EXPECT_THAT(told(japanese), HasSubstr("no character in Windows-1252"));
  EXPECT_THAT(told(japanese), Not(HasSubstr("\xC2\x8F"))) << "a control character";
  const auto german = with("L\xE4nge");
  EXPECT_TRUE(german.usable()) << told(german);
}

}  // namespace
}  // namespace sandhopper
