#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "campaign_folder.hpp"
#include "tools/campaign/trial_recording.hpp"

// Speeds and accelerations that are not the rates of what they belong to.
namespace sandhopper {
namespace {

// A plate that is driven down and slows down, with its acceleration times `scale`.
TrialRecording press(double scale) {
  std::string text = "t_s,foot_z_m,foot_velocity_mps,foot_accel_mps2,force_N\n";
  for (int i = 0; i < 300; ++i) {
    const double t = 1e-3 * i, depth_m = 0.015 * (1.0 - std::cos(10.0 * t));
    text += fmt::format("{:.6f},{:.7f},{:.6f},{:.5f},{:.3f}\n", t, -depth_m, -0.15 * std::sin(10.0 * t),
                        -1.5 * scale * std::cos(10.0 * t), 1500.0 * depth_m);
  }
  CampaignFolder folder;
  folder.write("campaign.toml", "plant = \"intruder\"\n[[trial]]\nfile = \"a.csv\"\n").write("a.csv", text);
  const auto campaign = load_campaign(folder.path());
  return read_trial(campaign, campaign.trials.at(0));
}

TEST(RateCheck, AnAccelerationOfTheOtherSignOrInGIsFound) {
  const auto complaint = [](const TrialRecording& recording) {
    const auto found = std::ranges::find_if(recording.findings, [](const Finding& finding) {
      return finding.kind == FindingKind::implausible && finding.channel == "foot_accel_mps2";
    });
    return found == recording.findings.end() ? std::string() : found->what;
  };
  EXPECT_EQ(complaint(press(1.0)), "");
  EXPECT_EQ(complaint(press(1.1)), "") << "a gain that a diagnosis finds";
  EXPECT_THAT(complaint(press(-1.0)), ::testing::HasSubstr("other sign"));
  EXPECT_THAT(complaint(press(1.0 / 9.80665)), ::testing::HasSubstr("an acceleration in g"));
}

}  // namespace
}  // namespace sandhopper
