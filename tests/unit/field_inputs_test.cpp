#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <optional>

#include "tools/campaign/trial_recording.hpp"
#include "tools/terrain/campaign_analysis.hpp"

// Made-up files in the formats of laboratories, each in a folder with the expected result (expected.txt). The
// folders are beside this repository and are read there.
namespace sandhopper {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

struct Looked {
  std::size_t usable = 0;
  std::vector<TrialRecording> trials;
  std::string told;
};

std::optional<Looked> look(const std::string& name) {
  const auto folder = std::filesystem::path(SANDHOPPER_SOURCE_DIR) / "../shared/data/field_inputs" / name;
  if (!std::filesystem::exists(folder / "campaign.toml")) {
    std::printf("*** SKIPPED: %s is not there; put the recordings beside this repository ***\n",
                folder.c_str());
    return std::nullopt;
  }
  const auto campaign = load_campaign(folder);
  Looked looked;
  for (const auto& finding : campaign.findings) looked.told += to_string(finding) + "\n";
  for (const auto& trial : campaign.trials) {
    looked.trials.push_back(read_trial(campaign, trial));
    looked.usable += looked.trials.back().usable();
    for (const auto& finding : looked.trials.back().findings) looked.told += to_string(finding) + "\n";
  }
  for (const char c : looked.told) EXPECT_TRUE(c == '\n' || static_cast<unsigned char>(c) >= 0x20) << name;
  return looked;
}

std::string terrain(const std::string& name) {
  const auto folder = std::filesystem::path(SANDHOPPER_SOURCE_DIR) / "../shared/data/field_inputs" / name;
  const auto report = report_on(analyse_campaign(load_campaign(folder), {}));
  std::string text;
  for (const auto& line : report.lines) text += line + "\n";
  return text;
}

#define LOOK(name)                \
  const auto looked = look(name); \
  if (!looked) GTEST_SKIP() << "field_inputs is not there"

TEST(FieldInput, F01MillimetresTakenForMetres) {
  LOOK("F01");
  EXPECT_EQ(looked->usable, 0U);
  EXPECT_THAT(looked->told, HasSubstr("its name says \"mm\""));
  EXPECT_THAT(looked->told, HasSubstr("scale = -0.001"));
  EXPECT_THAT(terrain("F01"), Not(HasSubstr("N/m")));
}

TEST(FieldInput, F01bARowOfUnits) {
  LOOK("F01b");
  EXPECT_EQ(looked->usable, 0U);
  EXPECT_THAT(looked->told, HasSubstr("unit = \"deg\", scale = 0.0174532925"));
  EXPECT_THAT(looked->told, HasSubstr("unit = \"rpm\", scale = 0.104719755"));
}

TEST(FieldInput, F04AllTimesAlike) {
  LOOK("F04");
  EXPECT_EQ(looked->usable, 0U);
  EXPECT_THAT(looked->told,
              HasSubstr("all 40 rows have the same time (1.73234e+09): written with too few digits"));
}

TEST(FieldInput, F04bTimesWithTwoDigits) {
  LOOK("F04b");
  EXPECT_EQ(looked->usable, 0U);
  EXPECT_THAT(looked->told, HasSubstr("times have a resolution of 10 ms"));
}

TEST(FieldInput, F09RemarksAboveTheNames) {
  LOOK("F09");
  ASSERT_EQ(looked->usable, 1U) << looked->told;
  EXPECT_EQ(looked->trials[0].rows(), 40U);
}

TEST(FieldInput, F09bTheMarkOfSavetxt) {
  LOOK("F09b");
  ASSERT_EQ(looked->usable, 1U) << looked->told;
  EXPECT_EQ(looked->trials[0].rows(), 40U);
}

TEST(FieldInput, F09cNamesInLineFourAndNoTime) {
  LOOK("F09c");
  EXPECT_EQ(looked->usable, 1U);
  EXPECT_THAT(looked->told, HasSubstr("stand in line 4"));
  EXPECT_THAT(looked->told, HasSubstr("the file has no time"));
  EXPECT_THAT(terrain("F09c"), HasSubstr("Depth law of 1 presses: power"));
}

TEST(FieldInput, F10DecimalCommas) {
  LOOK("F10");
  ASSERT_EQ(looked->usable, 1U) << looked->told;
  EXPECT_NEAR(looked->trials[0].channel("position_rad")[1], 0.29941, 1e-9);
}

TEST(FieldInput, F12Windows1252) {
  LOOK("F12");
  ASSERT_EQ(looked->usable, 1U) << looked->told;
  EXPECT_NEAR(looked->trials[0].channel("position_rad")[0], 0.3, 1e-4);
}

TEST(FieldInput, F12bUtf16) {
  LOOK("F12b");
  ASSERT_EQ(looked->usable, 1U) << looked->told;
  EXPECT_THAT(looked->told, HasSubstr("UTF-16"));
  EXPECT_EQ(looked->trials[0].rows(), 40U);
}

TEST(FieldInput, F18ForceAgainstDepthWithoutTime) {
  LOOK("F18");
  EXPECT_EQ(looked->usable, 2U);
  EXPECT_THAT(terrain("F18"), HasSubstr("exponent n = 2"));
}

TEST(FieldInput, F19APathOfWindows) {
  LOOK("F19");
  EXPECT_EQ(looked->usable, 0U);
  EXPECT_THAT(looked->told, HasSubstr("write file = \"data/rec.csv\", which exists"));
}

TEST(FieldInput, F21AHeldDepthAndEveryDashWithItsReason) {
  LOOK("F21");
  EXPECT_EQ(looked->usable, 2U);
  EXPECT_THAT(looked->told, HasSubstr("foot_z_m: is held over 4 rows"));
  EXPECT_THAT(terrain("F21"), HasSubstr("need three strokes of one plate, there are 2"));
  EXPECT_THAT(terrain("F21"), Not(HasSubstr("–")));
}

}  // namespace
}  // namespace sandhopper
