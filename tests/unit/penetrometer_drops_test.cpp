#include <gtest/gtest.h>

#include "shared_campaign.hpp"
#include "tools/terrain/penetrometer.hpp"

namespace sandhopper {
namespace {

class PenetrometerDrops : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto campaign = shared_campaign("penetrometer_drops");
    if (!campaign) GTEST_SKIP() << "the recordings are not there";
    EXPECT_TRUE(campaign->findings.empty());
    for (const auto& trial : campaign->trials) {
      const auto recording = read_trial(*campaign, trial);
      auto result = result_of(trial, recording);
      keep_drop(trial, recording, result);
      if (holds_drop(result)) drops_.push_back(drop_from(result));
    }
    ASSERT_EQ(drops_.size(), 3u);
  }
  std::vector<PenetrometerDrop> drops_;
};

TEST_F(PenetrometerDrops, OnlyTheFineSensorSaturatesAndAllAgreeWithTheReference) {
  for (const auto& drop : drops_) {
    EXPECT_EQ(drop.fused.reference, 0u);
    EXPECT_GT(drop.fused.calibration.at(1).saturated_samples, 200u);
    for (const std::size_t i : {0u, 2u, 3u}) EXPECT_EQ(drop.fused.calibration.at(i).saturated_samples, 0u);
    for (const auto& c : drop.fused.calibration) EXPECT_NEAR(c.scale, 1.0, 0.015);
    EXPECT_NEAR(drop.fused.calibration.at(2).bias_mps2, 0.68, 0.06);
  }
}

TEST_F(PenetrometerDrops, SpeedBackFromRestIsNearZeroWhereTheBodyHungSecondsBefore) {
  const double impact_mps[] = {4.24, 4.27, 5.06};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(drops_[i].impact_speed_mps, impact_mps[i], 0.1);
    EXPECT_NEAR(drops_[i].depth_m, 0.51, 0.04);
    EXPECT_LT(std::abs(drops_[i].speed_before_release_mps), 0.2);
    EXPECT_NEAR(drops_[i].fluid.alpha, 0.68, 0.04);
  }
}

TEST_F(PenetrometerDrops, RateHalvesWhatDepthAloneMissesOnTheDropLeftOut) {
  const auto fit = fit_penetrations(drops_);
  const auto& rate = fit.laws.at(static_cast<std::size_t>(ResistanceLaw::depth_power_rate));
  const auto& depth = fit.laws.at(static_cast<std::size_t>(ResistanceLaw::depth_power));
  EXPECT_EQ(fit.chosen, static_cast<std::size_t>(ResistanceLaw::depth_power_rate));
  EXPECT_NEAR(rate.cross_validation, 0.058, 0.012);
  EXPECT_NEAR(depth.cross_validation, 0.108, 0.015);
  EXPECT_NEAR(rate.fit.rate, 0.21, 0.04);
  EXPECT_GT(rate.rate.ci95_low, 0.0);
  for (const double correlation : fit.depth_speed_correlation) EXPECT_LT(correlation, -0.4);
}

TEST(PenetrometerDropsProfile, EachDropLiesInTheBandOfTheOthers) {
  const auto conclusions = shared_conclusions("penetrometer_drops");
  if (conclusions.is_null()) GTEST_SKIP() << "the recordings are not there";
  const auto& group = conclusions.at("profile").at("groups").at(0);
  EXPECT_EQ(group.at("source"), "drop");
  EXPECT_EQ(group.at("trials"), 3);
  double inside = 0.0, depths = 0.0;
  for (const auto& drop : group.at("leave_one_trial_out")) {
    inside += drop.at("inside").get<double>();
    depths += drop.at("depths").get<double>();
  }
  EXPECT_GT(inside / depths, 0.9);
  // Two drops determine the third only roughly.
  EXPECT_NEAR(group.at("exponent").at("value"), 1.68, 0.1);
}

}  // namespace
}  // namespace sandhopper
