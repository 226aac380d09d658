#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "campaign_folder.hpp"
#include "firmware/log/topics.hpp"
#include "tools/terrain/campaign_analysis.hpp"
#include "tools/terrain/hop_trials.hpp"
#include "tools/trial/campaign_maker.hpp"
#include "tools/trial/sim_trial.hpp"

namespace sandhopper {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using Json = nlohmann::ordered_json;

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string written(const CampaignResults& results) {
  std::ostringstream out;
  write_results(out, to_json(results), results);
  return out.str();
}

// Ten simulated hops.
class TerrainCampaign : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new CampaignFolder;
    CampaignMakerSetup setup;
    setup.folder = folder_->path();
    setup.trials = 10;
    make_hop_campaign(setup);
  }
  static void TearDownTestSuite() {
    delete folder_;
    folder_ = nullptr;
  }
  static CampaignFolder* folder_;
};
CampaignFolder* TerrainCampaign::folder_ = nullptr;

TEST_F(TerrainCampaign, ThreePartsMergedGiveTheSameNumbersToTheLastBit) {
  const auto campaign = load_campaign(folder_->path());
  const auto all = analyse_campaign(campaign, {.threads = 2});
  const auto whole = report_on(all);
  std::vector<CampaignResults> parts;
  for (const std::size_t part : {3UL, 1UL, 2UL}) {
    const auto results = analyse_campaign(campaign, {.part = part, .parts = 3});
    EXPECT_EQ(results.results.size(), part == 1 ? 4U : 3U);
    parts.push_back(campaign_results_from_json(Json::parse(written(results))));
  }
  const auto together = merge_parts(parts);
  const auto merged = report_on(together);
  EXPECT_EQ(written(together), written(all));
  EXPECT_EQ(merged.json.dump(), whole.json.dump());
  EXPECT_EQ(study_page(merged.study), study_page(whole.study));
}

TEST_F(TerrainCampaign, PartsThatDoNotMakeAWholeAreRefused) {
  const auto campaign = load_campaign(folder_->path());
  const auto first = analyse_campaign(campaign, {.part = 1, .parts = 2});
  const auto said = [](std::vector<CampaignResults> parts) -> std::string {
    try {
      merge_parts(std::move(parts));
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(said({first}), HasSubstr("trial 2 of the campaign is in none of the parts"));
  EXPECT_THAT(said({first, first}), HasSubstr("trial 1 of the campaign is in two of the parts"));
  auto other = analyse_campaign(campaign, {.part = 2, .parts = 2});
  other.campaign = "another";
  EXPECT_THAT(said({first, other}), HasSubstr("different campaigns"));
  EXPECT_THAT(said({}), HasSubstr("nothing to merge"));
}

TEST_F(TerrainCampaign, JointStiffnessFindsTheBed) {
  const auto report = report_on(analyse_campaign(load_campaign(folder_->path()), {}));
  const auto& joint = report.json.at("conclusions").at("hops").at("joint_pooled");
  EXPECT_NEAR(joint.at("value_N_per_m").get<double>(), 1500.0, 120.0);
  EXPECT_LT(joint.at("ci95_N_per_m").at(0).get<double>(), 1500.0);
  EXPECT_GT(joint.at("ci95_N_per_m").at(1).get<double>(), 1500.0);
  const auto& pooled = report.json.at("pooled").at("hop");
  EXPECT_GT(pooled.at("quasi_static_force_error_rms_N").at("value").get<double>(),
            2.0 * pooled.at("observer_force_error_rms_N").at("value").get<double>());
  EXPECT_LT(pooled.at("depth_error_rms_in_stance_m").at("value").get<double>(), 0.0017);
}

// The recorded channels alone must give the stiffness that the firmware computed while hopping.
TEST(TerrainHops, ARecordingReplaysToTheFirmwaresOwnStiffness) {
  CampaignFolder folder;
  CampaignMakerSetup setup;
  setup.folder = folder.path();
  setup.trials = 4;
  make_hop_campaign(setup);
  const auto results = analyse_campaign(load_campaign(folder.path()), {});
  const auto log = folder.path() / "again.mcap";
  SimTrialSetup again{.trial = {.release_height_m = 0.0618, .seed = 4}, .log = log};
  again.robot.limits.strides = 1;
  again.robot.controller.compression_stiffness_N_per_m = 250.0;
  run_sim_trial(again);
  mcap::Reader reader(log);
  TopicOf<StrideResult> strides(topic::kStride);
  StrideResult own{};
  for (mcap::Message message; reader.next(message);) strides.take(message, own);
  ASSERT_GT(own.observer_wls.value_N_per_m, 0.0);
  const auto near = [&](const char* way, double value) {
    const auto* found = results.results.at(3).find(stiffness_name(way, "A"));
    ASSERT_NE(found, nullptr);
    EXPECT_NEAR(found->value / value, 1.0, 0.03) << way;
  };
  near("quasi_static_ols", own.quasi_static_ols.value_N_per_m);
  near("observer_ols", own.observer_ols.value_N_per_m);
  near("observer_wls", own.observer_wls.value_N_per_m);
}

TrialResult without(const std::filesystem::path& from, const std::vector<std::string>& channels) {
  // Renames the columns to unknown names.
  CampaignFolder folder;
  std::string text = text_of(from / "trials/0003.csv");
  for (const auto& channel : channels) {
    const auto at = text.find(channel);
    text.replace(at, channel.size(), "x" + std::to_string(at));
  }
  folder
      .write("campaign.toml", "plant = \"hopper\"\n[[trial]]\nfile = \"a.csv\"\nrelease_height_m = 0.0303\n")
      .write("a.csv", text);
  return analyse_campaign(load_campaign(folder.path()), {}).results.at(0);
}

TEST_F(TerrainCampaign, MissingChannelsRuleOutConclusionsAndNothingElse) {
  const auto no_imu = without(folder_->path(), {"imu_foot_accel_z_mps2"});
  EXPECT_TRUE(no_imu.usable);
  EXPECT_THAT(no_imu.ruled_out, Contains(HasSubstr("imu_foot_accel_z_mps2 not recorded")));
  EXPECT_EQ(no_imu.find(stiffness_name("observer_wls", "A")), nullptr);
  EXPECT_NEAR(no_imu.value(stiffness_name("load_cell_ols", "A")), 1500.0, 250.0);

  const auto no_cell = without(folder_->path(), {"load_cell_force_N", "mocap_foot_z_m"});
  EXPECT_THAT(no_cell.ruled_out, Contains(HasSubstr("load_cell_force_N, mocap_foot_z_m not recorded")));
  EXPECT_TRUE(std::isfinite(no_cell.value(stiffness_name("observer_wls", "A"))));

  const auto poor =
      without(folder_->path(), {"phase", "tof_height_m", "motor_right_position_rad", "motor_right_current_A",
                                "motor_right_velocity_radps", "motor_left_velocity_radps"});
  EXPECT_THAT(poor.ruled_out, Contains(HasSubstr("right motor was not recorded")));
  EXPECT_THAT(poor.ruled_out, Contains(HasSubstr("no height sensor")));
  EXPECT_THAT(poor.ruled_out, Contains(HasSubstr("differences of the positions")));
  const auto full = without(folder_->path(), {});
  EXPECT_NEAR(
      poor.value(stiffness_name("observer_wls", "A")) / full.value(stiffness_name("observer_wls", "A")), 1.0,
      0.15);
}

// Pressure needs the plate's area. The default radius is no one's plate; the bed's numbers are not used here.
TEST(TerrainPlaceholders, APlateThatNobodyStatesIsSaid) {
  for (const bool stated : {false, true}) {
    CampaignFolder folder;
    folder.write("campaign.toml", std::string("plant = \"intruder\"\n[every_trial]\nkind = \"press\"\n") +
                                      (stated ? "plate_diameter_m = 0.04\n" : "") +
                                      "[[trial]]\nfile = \"1.csv\"\n");
    std::string rows = "force_N,foot_z_m\n";
    for (int i = 0; i < 60; ++i)
      rows += std::to_string(0.02 * i * i) + "," + std::to_string(-4e-4 * i) + "\n";
    folder.write("1.csv", rows);
    std::string told;
    for (const auto& finding : analyse_campaign(load_campaign(folder.path()), {}).findings)
      told += to_string(finding) + "\n";
    EXPECT_EQ(told.find("foot.radius_m: is stated nowhere, and 0.04 m") == std::string::npos, stated) << told;
    EXPECT_EQ(told.find("terrain.stiffness"), std::string::npos) << told;
  }
}

TEST(TerrainResults, SurviveJsonToTheLastBit) {
  TrialResult result;
  result.trial = "a.csv";
  result.kind = "hop";
  result.usable = true;
  result.setup = {{"release_height_m", 1.0 / 3.0}};
  result.quantities = {{"k_N_per_m", 1500.0 / 7.0, NAN}, {"bad_N", 1.0, 2.0, "too_shallow"}};
  result.series["depth_m"] = {0.1, NAN, 1e-300};
  result.findings = {{FindingKind::gap, FindingSeverity::note, "f", 3, 4, "t_s", "what", "cure"}};
  const auto back = trial_result_from_json(Json::parse(to_json(result).dump()));
  EXPECT_EQ(back.value("k_N_per_m"), 1500.0 / 7.0);
  EXPECT_TRUE(std::isnan(back.value("bad_N"))) << "an invalid figure is not a value";
  EXPECT_EQ(back.find("bad_N")->invalid, "too_shallow");
  EXPECT_EQ(back.setup_number("release_height_m"), 1.0 / 3.0);
  EXPECT_EQ(back.series.at("depth_m")[2], 1e-300);
  EXPECT_TRUE(std::isnan(back.series.at("depth_m")[1]));
  EXPECT_EQ(to_string(back.findings.at(0)), "f:3:4: t_s: what; cure");
  EXPECT_EQ(to_json(back), to_json(result));
}

TEST(TerrainResults, TheTrialIsTheUnitOfAnInterval) {
  std::vector<TrialResult> results(4);
  for (std::size_t i = 0; i < 4; ++i) results[i].quantities = {{"k_N", 10.0 + static_cast<double>(i), 0.001}};
  results[3].quantities[0].invalid = "too_shallow";
  std::vector<const TrialResult*> all;
  for (const auto& result : results) all.push_back(&result);
  const auto pooled = pool_quantities(all);
  ASSERT_EQ(pooled.size(), 1U);
  EXPECT_EQ(pooled[0].trials, 3U);
  EXPECT_DOUBLE_EQ(pooled[0].value, 11.0);
  EXPECT_NEAR(pooled[0].ci95_high - 11.0, 4.303 / std::sqrt(3.0), 1e-3);
}

}  // namespace
}  // namespace sandhopper
