#include "tools/terrain/press_trial.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "campaign_folder.hpp"

namespace sandhopper {
namespace {

// Pushed to 20 mm, drawn out, pushed to 30 mm. In its own hole the plate meets no ground, so these samples
// give no information on the bed.
TEST(PressTrial, ASecondPushCountsFromWhereItGoesDeeper) {
  std::string csv = "t_s,foot_z_m,force_N\n";
  double t = 0.0;
  const auto move = [&](double from_mm, double to_mm, double deepest_mm) {
    for (int i = 0; i < 400; ++i, t += 0.005) {
      const double z = from_mm + (to_mm - from_mm) * i / 400.0;
      const bool virgin = to_mm > from_mm && z > deepest_mm;
      csv += fmt::format("{:.3f},{:.6f},{:.3f}\n", t, -1e-3 * z, virgin ? 1.5 * z : 0.0);
    }
  };
  move(-5.0, 20.0, 0.0);
  move(20.0, -5.0, 20.0);
  move(-5.0, 30.0, 20.0);
  CampaignFolder folder;
  folder.write("campaign.toml", "plant = \"intruder\"\n[[trial]]\nfile = \"a.csv\"\n").write("a.csv", csv);
  const auto campaign = load_campaign(folder.path());
  const auto recording = read_trial(campaign, campaign.trials.at(0));
  auto result = result_of(campaign.trials.at(0), recording);
  keep_press(campaign.trials.at(0), recording, result);
  ASSERT_TRUE(holds_press(result));
  const auto press = press_from(result);
  ASSERT_GT(press.loading.samples.size(), 50U);
  for (const auto& sample : press.loading.samples) {
    if (sample.depth_m > 0.0199 && sample.depth_m < 0.0201) continue;  // the turning point
    EXPECT_NEAR(sample.force_N, 1500.0 * sample.depth_m, 0.1);
  }
}

TEST(PressTrial, AFastStrokeIsNoPress) {
  std::string csv = "t_s,foot_z_m,force_N\n";
  for (int i = 0; i < 200; ++i)
    csv += fmt::format("{:.3f},{:.6f},{:.3f}\n", 1e-3 * i, 0.01 - 3e-4 * i, 0.4 * i);
  CampaignFolder folder;
  folder.write("campaign.toml", "plant = \"intruder\"\n[[trial]]\nfile = \"a.csv\"\n").write("a.csv", csv);
  const auto campaign = load_campaign(folder.path());
  const auto recording = read_trial(campaign, campaign.trials.at(0));
  auto result = result_of(campaign.trials.at(0), recording);
  keep_press(campaign.trials.at(0), recording, result);
  EXPECT_FALSE(holds_press(result));
}

}  // namespace
}  // namespace sandhopper
