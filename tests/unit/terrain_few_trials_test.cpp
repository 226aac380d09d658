#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "campaign_folder.hpp"
#include "tools/terrain/campaign_analysis.hpp"

namespace sandhopper {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

CampaignResults results_of(const CampaignFolder& folder) {
  return analyse_campaign(load_campaign(folder.path()), {});
}

std::string press(double exponent) {
  std::string text = "t_s,foot_z_m,force_N\n";
  for (int i = 0; i <= 300; ++i) {
    const double depth_m = 1e-4 * i;
    text += std::to_string(0.01 * i) + "," + std::to_string(-depth_m) + "," +
            std::to_string(20.0 * std::pow(depth_m / 0.01, exponent)) + "\n";
  }
  return text;
}

TEST(TerrainFewTrials, OnePressIsFittedByTheLawThatSuitsItAndNothingIsTested) {
  CampaignFolder folder;
  folder.write("campaign.toml",
               "plant = \"intruder\"\n[[trial]]\nfile = \"a.csv\"\nkind = \"press\"\n"
               "plate_diameter_m = 0.06\n");
  folder.write("a.csv", press(1.3));
  const auto report = report_on(results_of(folder));
  const auto& told = report.json.at("conclusions").at("presses");
  EXPECT_EQ(told.at("chosen").at("law"), "power");
  EXPECT_NEAR(told.at("chosen").at("pooled_shape").get<double>(), 1.3, 0.01);
  EXPECT_TRUE(told.at("chosen").at("leave_one_trial_out_rms_N").is_null());
}

TEST(TerrainFewTrials, HopOnRigidGroundWithoutAPlateSaysWhatIsMissing) {
  CampaignFolder folder;
  folder.write("campaign.toml",
               "plant = \"hopper\"\nmodel = \"nominal.toml\"\n[[trial]]\nfile = \"a.csv\"\n");
  folder.write("nominal.toml", "[terrain]\nrigid = true\n");
  std::string text = "t_s,motor_left_position_rad,command_left_torque_Nm,phase\n";
  for (int i = 0; i < 200; ++i)
    text += std::to_string(1e-3 * i) + "," + std::to_string(1.0 + 0.1 * std::sin(0.05 * i)) + "," +
            std::to_string(-1.0 - 0.01 * i) + ",1\n";
  folder.write("a.csv", text);
  const auto results = results_of(folder);
  EXPECT_FALSE(report_on(results).json.at("conclusions").contains("leg_force"));
  EXPECT_THAT(results.results.at(0).ruled_out, Contains(HasSubstr("needs motor_left_position_rad")));
}

TEST(TerrainFewTrials, DropThatDoesNotEndAtRestIsNotUsed) {
  CampaignFolder folder;
  folder.write("campaign.toml", "plant = \"falling_body\"\n[[trial]]\nfile = \"a.csv\"\n");
  std::string text = "t_s,accel_mps2\n";
  for (int i = 0; i < 4000; ++i)
    text += std::to_string(1e-3 * i) + "," + std::to_string(9.81 + 2.0 * std::sin(0.03 * i)) + "\n";
  folder.write("a.csv", text);
  const auto results = results_of(folder);
  EXPECT_FALSE(report_on(results).json.at("conclusions").contains("penetrations"));
  EXPECT_THAT(results.results.at(0).ruled_out, Contains(HasSubstr("does not end at rest")));
}

// A plate that is driven in at 0.3 m/s to 60 mm and then held; the depth is recorded until depth_to_s.
std::string stroke(double depth_to_s) {
  std::string text = "t_s,foot_z_m,force_N\n";
  for (int i = 0; i <= 600; ++i) {
    const double t_s = 1e-3 * i, depth_m = std::min(-0.005 + 0.3 * t_s, 0.06);
    const double noise = std::sin(17.0 * i);
    const std::string depth = t_s <= depth_to_s ? std::to_string(-depth_m + 2e-5 * noise) : "";
    text += std::to_string(t_s) + "," + depth + "," +
            std::to_string(1000.0 * std::max(depth_m, 0.0) + 0.05 * noise) + "\n";
  }
  return text;
}

TrialResult result_of_stroke(double depth_to_s) {
  CampaignFolder folder;
  folder.write("campaign.toml",
               "plant = \"intruder\"\n[[trial]]\nfile = \"a.csv\"\nkind = \"intrusion\"\n"
               "plate_diameter_m = 0.08\n");
  folder.write("a.csv", stroke(depth_to_s));
  return results_of(folder).results.at(0);
}

double value_of(const TrialResult& result, const std::string& name) {
  for (const auto& quantity : result.quantities)
    if (quantity.name == name) return quantity.value;
  return NAN;
}

TEST(TerrainFewTrials, NoDepthIsMadeUpAfterTheLastRecordedOne) {
  const auto ends_early = result_of_stroke(0.1);  // 25 mm deep
  EXPECT_NEAR(value_of(ends_early, "max_depth_m"), 0.025, 5e-4);
  EXPECT_NEAR(value_of(ends_early, "slope_N_per_m"), 1000.0, 20.0);
  EXPECT_THAT(ends_early.ruled_out, Contains(HasSubstr("foot_z_m ends before force_N")));
  const auto whole = result_of_stroke(0.6);
  EXPECT_NEAR(value_of(whole, "max_depth_m"), 0.06, 5e-4);
  EXPECT_THAT(whole.ruled_out, Not(Contains(HasSubstr("foot_z_m ends before force_N"))));
}

}  // namespace
}  // namespace sandhopper
