#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <optional>
#include <random>

#include "read_campaign.hpp"
#include "tools/campaign/second_cells.hpp"

// Several load cells below one plate, and codes that a sensor writes where it has no sample. The cure of each
// message is followed, and sound neighbours give no message.
namespace sandhopper {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kHead =
    "plant = \"intruder\"\n[columns]\nt_s = { column = \"Time (s)\", unit = \"s\" }\nfoot_z_m = { column = "
    "\"Depth "
    "(mm)\", scale = -0.001 }\n";

// A press of 300 rows; `cells` gives the further cells of a row for its force.
Told press(const std::string& names, const std::function<std::string(double force_N, double noise_N)>& cells,
           const std::string& columns, const std::string& below = "") {
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0.0, 0.05);
  std::string text = "Time (s),Depth (mm)," + names + "\n";
  for (int i = 0; i < 300; ++i) {
    const double depth_mm = -2.0 + 0.1 * i, force = std::max(0.0, 2.0 * depth_mm);
    text += fmt::format("{:.2f},{:.3f},{}\n", 0.01 * i, depth_mm + 0.02 * noise(random),
                        cells(force + noise(random), noise(random)));
  }
  return read_campaign(std::string(kHead) + columns + below, text);
}
std::string two(double one, double other) { return fmt::format("{:.3f},{:.3f}", one, other); }
constexpr const char* kCellA = "force_N = { column = \"Load cell A (N)\", unit = \"N\" }\n";

TEST(ForeignCells, TwoCellsBelowAPlateAreAskedForAndAdded) {
  const auto shared = [](double force, double noise) { return two(0.6 * force, 0.4 * force + noise); };
  const auto asked = press("Load cell A (N),Load cell B (N)", shared, kCellA);
  EXPECT_FALSE(asked.recording.usable());
  EXPECT_THAT(asked.text, HasSubstr("Load cell B (N) is loaded together with it"));
  const std::string sum = "force_N = { column = [\"Load cell A (N)\", \"Load cell B (N)\"], unit = \"N\" }";
  EXPECT_THAT(asked.text, HasSubstr(sum));
  const auto added = press("Load cell A (N),Load cell B (N)", shared, sum + "\n");
  ASSERT_TRUE(added.recording.usable()) << added.text;
  EXPECT_THAT(added.text, Not(HasSubstr("loaded together")));
  EXPECT_NEAR(added.recording.channel("force_N")[299], 55.8, 0.3);
  const auto whole = press("Load cell A (N),Load cell B (N)", shared,
                           "force_N = { column = \"Load cell A (N)\", unit = \"N\", scale = 1.0 }\n");
  EXPECT_TRUE(whole.recording.usable()) << whole.text;
}

TEST(ForeignCells, CellsInOtherUnitsAreAddedInTheChannelsUnit) {
  const auto told = press(
      "Fz1 (N),Fz2 (kN)",
      [](double force, double noise) {
        return fmt::format("{:.3f},{:.6f}", 0.6 * force, (0.4 * force + noise) / 1e3);
      },
      "force_N = { column = [\"Fz1 (N)\", \"Fz2 (kN)\"] }\n");
  ASSERT_TRUE(told.recording.usable()) << told.text;
  EXPECT_NEAR(told.recording.channel("force_N")[299], 55.8, 0.3);
}

TEST(ForeignCells, ASumNeedsEveryColumn) {
  const auto shared = [](double force, double noise) { return two(0.6 * force, 0.4 * force + noise); };
  const auto missing = press("Load cell A (N),Load cell B (N)", shared,
                             "force_N = { column = [\"Load cell A (N)\", \"Load cell C (N)\"] }\n");
  EXPECT_FALSE(missing.recording.usable());
  EXPECT_THAT(missing.text, HasSubstr("no column is called \"Load cell C (N)\""));
  CampaignFolder twice;
  twice.write(
      "campaign.toml",
      std::string(kHead) + "force_N = { column = [\"A (N)\", \"A (N)\"] }\n[[trial]]\nfile = \"a.csv\"\n");
  const auto campaign = load_campaign(twice.path());
  EXPECT_TRUE(campaign.trials.empty());
  ASSERT_FALSE(campaign.findings.empty());
  EXPECT_THAT(to_string(campaign.findings.front()), HasSubstr("this mapping cannot be understood"));
}

TEST(ForeignCells, AnotherForceThatIsNamedOtherwiseIsNoted) {
  const auto told = press(
      "Load cell A (N),Frame (N)", [](double force, double noise) { return two(force, 0.7 * force + noise); },
      kCellA);
  EXPECT_TRUE(told.recording.usable()) << told.text;
  EXPECT_THAT(told.text, HasSubstr("Frame (N) is loaded together with it"));
}

TEST(ForeignCells, WhatIsNoSecondCellGivesNoMessage) {
  struct Neighbour {
    std::string name;
    std::function<std::string(double, double)> cells;
  };
  for (const auto& [name, cells] :
       {Neighbour{"Load cell B (N)",
                  [](double force, double noise) { return two(force, noise); }},  // unloaded
        Neighbour{"Load cell (kN)",
                  [](double force, double) { return fmt::format("{:.3f},{:.6f}", force, force / 1e3); }},
        Neighbour{"Tared (N)", [](double force, double) { return two(force, force - 3.2); }},
        Neighbour{"Force filtered (N)", [](double force, double noise) { return two(force, force + noise); }},
        Neighbour{"Force target (N)", [](double force, double noise) { return two(force, force + noise); }},
        Neighbour{"Voltage (V)",
                  [](double force, double noise) { return two(force, 0.1 * force + noise); }}}) {
    const auto told = press("Load cell A (N)," + name, cells, kCellA);
    EXPECT_TRUE(told.recording.usable()) << told.text;
    EXPECT_THAT(told.text, Not(HasSubstr("loaded together"))) << name;
  }
  const auto axes = press(
      "Fz (N),Fx (N),Fy (N)",
      [](double force, double noise) {
        return fmt::format("{:.3f},{:.3f},{:.3f}", force, 0.2 * force + noise, noise);
      },
      "force_N = { column = \"Fz (N)\", unit = \"N\" }\n");
  EXPECT_THAT(axes.text, Not(HasSubstr("loaded together")));
}

TEST(ForeignCells, ACellOfAnotherTrialOfTheFileIsReadThere) {
  CampaignFolder folder;
  std::string text = "t_s,z1,z2,F1 (N),F2 (N)\n";
  for (int i = 0; i < 100; ++i)
    text += fmt::format("{:.1f},{:.5f},{:.5f},{:.3f},{:.3f}\n", 0.1 * i, -4e-4 * i, -4.1e-4 * i,
                        0.5 * i + std::sin(i), 0.6 * i + std::sin(3 * i));
  folder.write("a.csv", text).write("campaign.toml", R"toml(plant = "intruder"
[[trial]]
file = "a.csv"
columns = { foot_z_m = { column = "z1", unit = "m" }, force_N = { column = "F1 (N)", unit = "N" } }
[[trial]]
file = "a.csv"
columns = { foot_z_m = { column = "z2", unit = "m" }, force_N = { column = "F2 (N)", unit = "N" } }
)toml");
  const auto campaign = load_campaign(folder.path());
  for (const auto& trial : campaign.trials)
    for (const auto& finding : read_trial(campaign, trial).findings)
      EXPECT_THAT(to_string(finding), Not(HasSubstr("loaded together")));
}

TEST(ForeignCells, CellsOfASecondFileAreAddedToo) {
  CampaignFolder folder;
  std::string depths = "t_s,foot_z_m\n", forces = "t_s,F1 (N),F2 (N)\n";
  for (int i = 0; i < 100; ++i) {
    depths += fmt::format("{:.2f},{:.5f}\n", 0.01 * i, -4e-4 * i);
    forces += fmt::format("{:.2f},{:.3f},{:.3f}\n", 0.01 * i, 0.5 * i + 0.1 * std::sin(i),
                          0.6 * i + 0.1 * std::sin(3 * i));
  }
  const auto told = [&](const std::string& column) {
    folder.write("a.csv", depths)
        .write("b.csv", forces)
        .write("campaign.toml",
               "plant = \"intruder\"\n[[trial]]\nfile = \"a.csv\"\nalso = { file = \"b.csv\", columns = { "
               "force_N = { "
               "column = " +
                   column + ", unit = \"N\" } } }\n");
    const auto campaign = load_campaign(folder.path());
    std::string text;
    for (const auto& finding : read_trial(campaign, campaign.trials.at(0)).findings)
      text += to_string(finding) + "\n";
    return text;
  };
  EXPECT_THAT(told("\"F1 (N)\""), HasSubstr("F2 (N) is loaded together with it"));
  EXPECT_THAT(told("[\"F1 (N)\", \"F2 (N)\"]"), Not(HasSubstr("loaded together")));
}

TEST(ForeignCells, NamesThatDifferInOneNumberLetterOrSideAreAlike) {
  for (const auto& [one, other] : {std::pair{"Load cell A (N)", "Load cell B (N)"},
                                   std::pair{"Fz1 (N)", "Fz2 (N)"}, std::pair{"Kraft links", "Kraft rechts"}})
    EXPECT_TRUE(are_named_alike(one, other)) << one;
  for (const auto& [one, other] : {std::pair{"Force (N)", "Frame (N)"}, std::pair{"Fx (N)", "Fz (N)"},
                                   std::pair{"F (N)", "F (N)"}, std::pair{"A1", "B2"}})
    EXPECT_FALSE(are_named_alike(one, other)) << one;
}

// A fall from 3 m in mm, of 80 rows 10 ms apart; `code` replaces some heights.
std::string fall(const std::function<std::optional<double>(int i, double height_mm)>& code) {
  std::string text = "t_s,height (mm)\n";
  for (int i = 0; i < 80; ++i) {
    const double t = 0.01 * i, height_mm = std::round(3300.0 - 4905.0 * t * t);
    text += fmt::format("{:.2f},{:.0f}\n", t, code(i, height_mm).value_or(height_mm));
  }
  return text;
}
constexpr const char* kDrop =
    "plant = \"falling_body\"\n[columns]\nheight_m = { column = \"height (mm)\", unit = \"mm\" "
    "}\n[every_trial]\nkind "
    "= \"drop\"\n";

TEST(ForeignCells, ACodeThatASensorRepeatsIsNamedAndLeftOut) {
  for (const double code : {8190.0, 0.0, -1.0}) {
    const auto text =
        fall([&](int i, double) { return i % 9 == 4 || i == 0 ? std::optional(code) : std::nullopt; });
    const auto asked = read_campaign(kDrop, text);
    EXPECT_FALSE(asked.recording.usable());
    EXPECT_THAT(asked.text, HasSubstr(fmt::format("reads {:.0f} in 10 rows", code)));
    const auto line = fmt::format("no_sample = [\"{:.0f}\"]", code);
    EXPECT_THAT(asked.text, HasSubstr(line));
    EXPECT_THAT(asked.text, Not(HasSubstr("release_speed_mps"))) << "a cure that does not follow from a code";
    const auto read = read_campaign(std::string(kDrop) + "[format]\n" + line + "\n", text);
    EXPECT_TRUE(read.recording.usable()) << read.text;
  }
}

// Every thirteenth angle of an axis is `code`.
std::string swing_with_code(double code) {
  std::string text = "t_s,position_rad,torque_Nm\n";
  for (int i = 0; i < 300; ++i)
    text += fmt::format("{:.2f},{:.5f},{:.3f}\n", 0.01 * i,
                        i % 13 == 5 ? code : std::cos(0.05 * i) + 1e-3 * (i % 3), std::sin(0.3 * i));
  return text;
}

TEST(ForeignCells, ACodeWithinTheWayIsNamedToo) {
  const auto text = swing_with_code(0.25);
  const auto asked = read_campaign("plant = \"rotary_axis\"", text);
  EXPECT_FALSE(asked.recording.usable());
  EXPECT_THAT(asked.text, HasSubstr("no_sample = [\"0.25\"]"));
  EXPECT_TRUE(
      read_campaign("plant = \"rotary_axis\"\n[format]\nno_sample = [\"0.25\"]", text).recording.usable());
}

TEST(ForeignCells, ZerosOfAnAxisAreLeftToTheDiagnosis) {
  const auto noted = read_campaign("plant = \"rotary_axis\"", swing_with_code(0.0));
  EXPECT_TRUE(noted.recording.usable()) << noted.text;
  EXPECT_THAT(noted.text, HasSubstr("data.dropout"));
}

TEST(ForeignCells, WhatIsNoCodeGivesNoMessage) {
  const auto sound = read_campaign(kDrop, fall([](int, double) { return std::nullopt; }));
  EXPECT_TRUE(sound.recording.usable()) << sound.text;
  EXPECT_THAT(sound.text, Not(HasSubstr("a code")));
  // One row is lost: one value that is not repeated may be anything.
  const auto once = read_campaign(
      kDrop, fall([](int i, double) { return i == 30 ? std::optional(8190.0) : std::nullopt; }));
  EXPECT_THAT(once.text, Not(HasSubstr("a code that the sensor writes")));
  // A way that begins again at 0, four times.
  std::string again = "t_s,position_rad,torque_Nm\n";
  for (int i = 0; i < 200; ++i)
    again += fmt::format("{:.2f},{:.3f},{:.3f}\n", 0.01 * i, 0.1 * (i % 45), std::sin(0.3 * i));
  EXPECT_THAT(read_campaign("plant = \"rotary_axis\"", again).text,
              Not(HasSubstr("a code that the sensor writes")));
  // An axis that is switched between two angles.
  std::string text = "t_s,position_rad,torque_Nm\n";
  for (int i = 0; i < 200; ++i)
    text += fmt::format("{:.2f},{:.3f},{:.3f}\n", 0.01 * i, 1.0 * (i / 20 % 2), std::sin(0.3 * i));
  EXPECT_THAT(read_campaign("plant = \"rotary_axis\"", text).text,
              Not(HasSubstr("a code that the sensor writes")));
}

}  // namespace
}  // namespace sandhopper
