#include <gtest/gtest.h>

#include "shared_campaign.hpp"
#include "tools/terrain/intrusion_fit.hpp"

namespace sandhopper {
namespace {

class PlateInSand : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto campaign = shared_campaign("plate_in_sand");
    if (!campaign) GTEST_SKIP() << "the recordings are not there";
    EXPECT_TRUE(campaign->findings.empty());
    std::vector<PressTrial> presses;
    for (const auto& trial : campaign->trials) {
      const auto recording = read_trial(*campaign, trial);
      auto result = result_of(trial, recording);
      keep_press(trial, recording, result);
      if (holds_press(result)) presses.push_back(press_from(result));
    }
    fit_ = fit_intrusions(presses);
  }
  const LawResult& law(DepthLaw kind) const { return fit_.laws.at(static_cast<std::size_t>(kind)); }

  IntrusionFit fit_;
};

TEST_F(PlateInSand, SmallPlatesChooseTheConfinedLayerAndPredictTheLargerOnes) {
  EXPECT_EQ(fit_.fit_trials, 3u);
  EXPECT_EQ(fit_.held_out_trials, 3u);
  ASSERT_EQ(fit_.chosen, static_cast<std::size_t>(DepthLaw::confined_layer));
  const auto& chosen = law(DepthLaw::confined_layer);
  EXPECT_NEAR(chosen.cross_validation_N, 2.5, 0.4);
  EXPECT_NEAR(chosen.heldout_rms_N, 7.0, 1.5);
  EXPECT_NEAR(chosen.relative_error.at(0), 0.12, 0.06);
  EXPECT_NEAR(chosen.relative_error.at(1), 0.02, 0.04);
  EXPECT_NEAR(chosen.relative_error.at(2), -0.04, 0.04);
  EXPECT_LT(std::abs(chosen.relative_error.at(2)), 0.20);
}

TEST_F(PlateInSand, PressureAtOneDepthThatIgnoresThePlateIsAQuarterTooLow) {
  EXPECT_NEAR(law(DepthLaw::power).relative_error.at(2), -0.25, 0.04);
  EXPECT_NEAR(law(DepthLaw::power).shape.value, 1.48, 0.1);
  EXPECT_NEAR(fit_.area.at(2).exponent.value, 1.59, 0.1);  // differs from 1
  EXPECT_GT(fit_.area.at(2).exponent.ci95_low, 1.0);
}

TEST_F(PlateInSand, WhatYieldsOnTheStopDoesNotYieldInTheBed) {
  const auto& rig = fit_.rig;
  EXPECT_EQ(rig.stop_compliance_m_per_N.trials, 3u);
  EXPECT_NEAR(rig.stop_compliance_m_per_N.value, 11.8e-6, 1.0e-6);
  EXPECT_NEAR(rig.stop_unloading_N_per_m.value, 87e3, 15e3);
  EXPECT_GT(rig.bed_unloading_N_per_m.value, 5.0 * rig.stop_unloading_N_per_m.value);
  EXPECT_EQ(rig.compliance_used_m_per_N, 0.0);
  ASSERT_TRUE(fit_.with_stop_compliance);
  EXPECT_NEAR(fit_.with_stop_compliance->relative_error.at(2), -0.08, 0.04);
}

// Share of the held-out depths within the band of one new trial, if this law scales the profile of the 60 mm
// plates.
double share_inside(const nlohmann::ordered_json& profile, std::string_view law) {
  for (const auto& p : profile.at("held_out"))
    if (p.at("law") == law) return p.at("inside").get<double>() / p.at("depths").get<double>();
  return NAN;
}

class PlateInSandProfile : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto conclusions = shared_conclusions("plate_in_sand");
    if (conclusions.is_null()) GTEST_SKIP() << "the recordings are not there";
    profile_ = conclusions.at("profile");
  }
  nlohmann::ordered_json profile_;
};

TEST_F(PlateInSandProfile, TrialsOfOnePlateLieInTheBandOfTheOthers) {
  ASSERT_EQ(profile_.at("groups").size(), 1u);
  const auto& group = profile_.at("groups")[0];
  EXPECT_EQ(group.at("trials"), 3);
  EXPECT_NEAR(group.at("foot_diameter_m"), 0.06, 1e-9);
  double inside = 0.0, depths = 0.0;
  for (const auto& trial : group.at("leave_one_trial_out")) {
    inside += trial.at("inside").get<double>();
    depths += trial.at("depths").get<double>();
  }
  EXPECT_GT(inside / depths, 0.9);
}

TEST_F(PlateInSandProfile, AreaLawMissesTheLargerPlates) {
  std::printf("80 mm plates inside the band from 60 mm plates: area law %.0f %%, confined layer %.0f %%\n",
              100.0 * share_inside(profile_, "area law"), 100.0 * share_inside(profile_, "confined layer"));
  EXPECT_NEAR(share_inside(profile_, "area law"), 0.59, 0.1);
  EXPECT_NEAR(share_inside(profile_, "confined layer"), 1.0, 0.05);
}

}  // namespace
}  // namespace sandhopper
