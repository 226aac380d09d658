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

// A plate that is driven down and slows down, with its acceleration times `scale` plus `offset_mps2`.
TrialRecording press(double scale, double offset_mps2 = 0.0, const std::string& columns = "") {
  std::string text = "t_s,foot_z_m,foot_velocity_mps,foot_accel_mps2,force_N\n";
  for (int i = 0; i < 300; ++i) {
    const double t = 1e-3 * i, depth_m = 0.015 * (1.0 - std::cos(10.0 * t));
    text += fmt::format("{:.6f},{:.7f},{:.6f},{:.5f},{:.3f}\n", t, -depth_m, -0.15 * std::sin(10.0 * t),
                        -1.5 * scale * std::cos(10.0 * t) + offset_mps2, 1500.0 * depth_m);
  }
  CampaignFolder folder;
  folder.write("campaign.toml", "plant = \"intruder\"\n" + columns + "[[trial]]\nfile = \"a.csv\"\n")
      .write("a.csv", text);
  const auto campaign = load_campaign(folder.path());
  return read_trial(campaign, campaign.trials.at(0));
}

std::string complaint(const TrialRecording& recording, bool cure = false) {
  const auto found = std::ranges::find_if(recording.findings, [](const Finding& finding) {
    return finding.kind == FindingKind::implausible && finding.channel == "foot_accel_mps2";
  });
  return found == recording.findings.end() ? std::string() : cure ? found->cure : found->what;
}

TEST(RateCheck, AnAccelerationOfTheOtherSignOrInGIsFound) {
  EXPECT_EQ(complaint(press(1.0)), "");
  EXPECT_EQ(complaint(press(1.1)), "") << "a gain that a diagnosis finds";
  EXPECT_THAT(complaint(press(-1.0)), ::testing::HasSubstr("other sign"));
  EXPECT_THAT(complaint(press(1.0 / 9.80665)), ::testing::HasSubstr("an acceleration in g"));
}

// An accelerometer at rest reads 1 g; the foot's acceleration is 0. A sensor's own offset is left alone.
TEST(GravityCheck, AnAccelerationThatHoldsGravityIsFoundAndCured) {
  EXPECT_EQ(complaint(press(1.0, 0.5)), "");
  EXPECT_THAT(complaint(press(1.0, 9.81)), ::testing::HasSubstr("9.81 m/s2 more than foot_z_m shows"));
  EXPECT_THAT(complaint(press(1.0, -9.6)), ::testing::HasSubstr("-9.60 m/s2 more"));
  const auto cure = complaint(press(1.0, 9.81), true);
  EXPECT_THAT(cure, ::testing::HasSubstr("offset = -9.81"));
  const auto from = cure.find("foot_accel_mps2 = "), to = cure.find('}') + 1;
  EXPECT_EQ(complaint(press(1.0, 9.81, "[columns]\n" + cure.substr(from, to - from) + "\n")), "");
}

}  // namespace
}  // namespace sandhopper
