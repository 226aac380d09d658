#include "tools/campaign/side_by_side.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <regex>

#include "campaign_folder.hpp"
#include "tools/campaign/campaign_draft.hpp"

// Recordings side by side in one table are imported as a [[trial]] each.
namespace sandhopper {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

struct Imported {
  CampaignDraft draft;
  std::vector<TrialRecording> trials;
};
Imported imported(const std::string& text, CampaignPlant plant) {
  CampaignFolder folder;
  folder.write("a.csv", text);
  Imported out{draft_campaign({folder.path() / "a.csv"}, plant, folder.path()), {}};
  folder.write("campaign.toml", out.draft.campaign_toml)
      .write("nominal.toml", std::regex_replace(out.draft.nominal_toml, std::regex("\"\\?\""), "1.0"));
  const auto campaign = load_campaign(folder.path());
  for (const auto& trial : campaign.trials) out.trials.push_back(read_trial(campaign, trial));
  return out;
}

double angle_rad(int i, double turns) { return turns * std::cos(0.05 * i); }

// Two swings of 0.3 and 0.5 rad; the second is 20 rows shorter.
std::string two_swings(const std::string& names) {
  std::string text = names + "\n";
  for (int i = 0; i < 100; ++i) {
    text += fmt::format("{:.2f};{:.5f};", 0.01 * i, angle_rad(i, 0.3));
    text += i < 80 ? fmt::format("{:.2f};{:.5f}\n", 1.0 + 0.01 * i, angle_rad(i, 0.5)) : ";\n";
  }
  return text;
}

TEST(SideBySide, EachRecordingBecomesATrial) {
  for (const auto* names :
       {"t1 (s);theta1 (rad);t2 (s);theta2 (rad)", "t (s);theta (rad);t (s).1;theta (rad).1",
        "Run 1: t (s);Run 1: theta (rad);Run 2: t (s);Run 2: theta (rad)"}) {
    const auto got = imported(two_swings(names), CampaignPlant::rotary_axis);
    EXPECT_THAT(got.draft.said, Contains(HasSubstr("2 recordings side by side"))) << names;
    ASSERT_EQ(got.trials.size(), 2U) << got.draft.campaign_toml;
    for (const std::size_t k : {0U, 1U}) {
      ASSERT_TRUE(got.trials[k].usable())
          << got.draft.campaign_toml << to_string(got.trials[k].findings.front());
      EXPECT_EQ(got.trials[k].rows(), k == 0 ? 100U : 80U);
      EXPECT_NEAR(got.trials[k].t_s.front(), k == 0 ? 0.0 : 1.0, 1e-9);
      EXPECT_NEAR(got.trials[k].channel("position_rad")[10], angle_rad(10, k == 0 ? 0.3 : 0.5), 1e-4);
    }
  }
}

TEST(SideBySide, ARecordingTakesNoColumnOfAnother) {
  std::string text = "Time 1 (s),Force 1 (N),Depth 1 (mm),Time 2 (s),Force 2 (N)\n";
  for (int i = 0; i < 80; ++i)
    text += fmt::format("{0:.1f},{1:.3f},{2:.3f},{0:.1f},{3:.3f}\n", 0.1 * i, 10.0 + 0.05 * i * i, 0.4 * i,
                        11.0 + 0.06 * i * i);
  const auto got = imported(text, CampaignPlant::intruder);
  ASSERT_EQ(got.trials.size(), 2U) << got.draft.campaign_toml;
  EXPECT_TRUE(got.trials[0].has("foot_z_m"));
  EXPECT_FALSE(got.trials[1].has("foot_z_m")) << "the second recording has no depth";
  ASSERT_TRUE(got.trials[1].has("force_N"));
  EXPECT_NEAR(got.trials[1].channel("force_N")[10], 17.0, 1e-3);
}

TEST(SideBySide, OneRecordingStaysOneTrial) {
  const auto groups = [](const std::vector<std::string>& names) {
    CsvTable table;
    table.names = names;
    table.units.resize(names.size());
    return recordings_side_by_side(table).size();
  };
  EXPECT_EQ(groups({"t1", "theta1", "t2", "theta2"}), 2U);
  EXPECT_EQ(groups({"t (s)", "theta1 (rad)", "theta2 (rad)"}), 0U) << "two sensors, one clock";
  EXPECT_EQ(groups({"Time 1", "Force 1", "Time 2", "Depth 2"}), 0U) << "each sensor has its clock";
  EXPECT_EQ(groups({"t_s", "force_N", "foot_z_m"}), 0U);
  EXPECT_EQ(groups({"t1", "theta1", "t2"}), 0U) << "a second clock alone";
  EXPECT_EQ(groups({"Time (m/s2)", "a (m/s2)"}), 0U);
}

}  // namespace
}  // namespace sandhopper
