#include <gtest/gtest.h>

#include "campaign_folder.hpp"
#include "tools/campaign/trial_recording.hpp"
#include "tools/trial/sim_trial.hpp"

namespace sandhopper {
namespace {

// A simulated hop, as `hop trial` records it, must be a complete trial of a campaign without false reports of
// channels that rest, saturate or stick.
TEST(CampaignLog, ASimulatedHopIsReadFromItsFolderWithoutComplaint) {
  for (const double height_m : {0.0025, 0.0618}) {
    CampaignFolder folder;
    folder.write("campaign.toml", "plant = \"hopper\"\n[[trial]]\nfile = \"hop\"\n").write("hop/x", "");
    run_sim_trial({.trial = {.release_height_m = height_m}, .log = folder.path() / "hop" / "trial_001.mcap"});
    const auto campaign = load_campaign(folder.path());
    const auto recording = read_trial(campaign, campaign.trials.at(0));
    ASSERT_TRUE(recording.usable());
    for (const auto& finding : recording.findings) ADD_FAILURE() << to_string(finding);
    EXPECT_TRUE(recording.has("motor_left_current_A"));
    EXPECT_TRUE(recording.has("mocap_foot_z_m"));
    EXPECT_TRUE(recording.has("estimate_contact_force_N"));
    EXPECT_GT(recording.rows(), 2000U);
  }
}

TEST(CampaignLog, AHopWithoutNoiseIsReadWithoutComplaint) {
  CampaignFolder folder;
  folder.write("campaign.toml", "plant = \"hopper\"\n[[trial]]\nfile = \"trial.mcap\"\n");
  run_sim_trial({.trial = {.noise = false}, .log = folder.path() / "trial.mcap"});
  const auto campaign = load_campaign(folder.path());
  const auto recording = read_trial(campaign, campaign.trials.at(0));
  EXPECT_TRUE(recording.usable());
  for (const auto& finding : recording.findings) ADD_FAILURE() << to_string(finding);
}

TEST(CampaignLog, WhatIsNoLogIsSaidSo) {
  CampaignFolder folder;
  folder.write("campaign.toml", "plant = \"hopper\"\n[[trial]]\nfile = \"trial.mcap\"\n")
      .write("trial.mcap", "text");
  const auto campaign = load_campaign(folder.path());
  const auto recording = read_trial(campaign, campaign.trials.at(0));
  ASSERT_EQ(recording.findings.size(), 1U);
  EXPECT_EQ(recording.findings[0].kind, FindingKind::unreadable_file);
}

}  // namespace
}  // namespace sandhopper
