#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "campaign_folder.hpp"
#include "tools/campaign/lost_channels.hpp"
#include "tools/campaign/trial_recording.hpp"

namespace sandhopper {
namespace {

using ::testing::HasSubstr;

constexpr auto kHop =
    "plant = \"hopper\"\n[every_trial]\nstance_position_gain_Nm_per_rad = 1.5\nstance_target_rad = 0.9\n"
    "also = { file = \"plate.csv\", columns = { t_s = \"t\", load_cell_force_N = { column = \"Fz\", scale = "
    "-1.0 "
    "} } }\n[columns]\nmotor_left_position_rad = \"x\"\nphase = { column = \"mode\", offset = -1.0 }\n"
    "command_left_torque_Nm = { column = \"u\", scale = 0.5 }\n[[trial]]\nfile = \"a.csv\"\n";

CampaignFolder& fill(CampaignFolder& folder) {
  folder.write("campaign.toml", kHop);
  folder.write("a.csv", "t_s,x,u,mode\n1.0,1.0,0.2,2\n1.1,1.2,0.4,2\n1.2,1.3,0,1\n");
  return folder.write("plate.csv", "t,Fz\n0.9,-9\n1.05,-1\n1.1,-2\n1.15,-3\n1.3,-9\n");
}

TEST(Campaign, SecondFileOfATrialIsPutBetweenTheRowsOfTheFirst) {
  CampaignFolder folder;
  const auto campaign = load_campaign(fill(folder).path());
  EXPECT_TRUE(campaign.findings.empty());
  const auto recording = read_trial(campaign, campaign.trials.at(0));
  EXPECT_EQ(recording.t_s, (std::vector{1.0, 1.05, 1.1, 1.15, 1.2}));
  const auto force = recording.channel("load_cell_force_N");
  EXPECT_TRUE(std::isnan(force[0]));
  EXPECT_EQ(force[1], 1.0);
  EXPECT_EQ(force[2], 2.0);
  EXPECT_TRUE(std::isnan(recording.channel("phase")[1]));
}

TEST(Campaign, TorqueOfALoopClosedInTheDriveIsAddedToTheFeedForward) {
  CampaignFolder folder;
  const auto campaign = load_campaign(fill(folder).path());
  const auto recording = read_trial(campaign, campaign.trials.at(0));
  const auto torque = recording.channel("command_left_torque_Nm");
  EXPECT_NEAR(torque[0], 0.1 + 1.5 * (0.9 - 1.0), 1e-12);
  EXPECT_NEAR(torque[2], 0.2 + 1.5 * (0.9 - 1.2), 1e-12);
  EXPECT_NEAR(torque[4], 0.0, 1e-12);  // flight, without a control loop
}

TEST(Campaign, MissingSecondFileCostsItsChannelsOnly) {
  CampaignFolder folder;
  fill(folder);
  std::filesystem::remove(folder.path() / "plate.csv");
  const auto campaign = load_campaign(folder.path());
  const auto recording = read_trial(campaign, campaign.trials.at(0));
  EXPECT_TRUE(recording.usable());
  EXPECT_FALSE(recording.has("load_cell_force_N"));
  ASSERT_FALSE(recording.findings.empty());
  EXPECT_EQ(recording.findings.back().kind, FindingKind::missing_file);
}

// The plate's times begin at 100 s, those of the trial at 1 s.
TEST(Campaign, SecondFileOnAnotherClockIsSaid) {
  CampaignFolder folder;
  fill(folder).write("plate.csv", "t,Fz\n100.9,-9\n101.05,-1\n101.1,-2\n");
  const auto campaign = load_campaign(folder.path());
  const auto recording = read_trial(campaign, campaign.trials.at(0));
  EXPECT_TRUE(recording.usable());
  const auto& finding = recording.findings.back();
  EXPECT_EQ(finding.severity, FindingSeverity::channel_unusable);
  EXPECT_THAT(to_string(finding), HasSubstr("plate.csv"));
  EXPECT_THAT(finding.what, HasSubstr("100.9 to 101.1 s, are outside those of the trial, 1 to 1.2 s"));
  EXPECT_THAT(finding.cure, HasSubstr("offset = SECONDS"));
  LostChannels lost(campaign.plant);
  lost.add(campaign.trials.at(0), recording);
  EXPECT_EQ(lost.words(), ", without load_cell_force_N in 1 trial");
}

TEST(Campaign, ChannelsOfASoundTrialAreNotLost) {
  CampaignFolder folder;
  const auto campaign = load_campaign(fill(folder).path());
  LostChannels lost(campaign.plant);
  lost.add(campaign.trials.at(0), read_trial(campaign, campaign.trials.at(0)));
  EXPECT_EQ(lost.words(), "");
}

}  // namespace
}  // namespace sandhopper
