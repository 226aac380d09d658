#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "campaign_folder.hpp"
#include "tools/campaign/belief_sources.hpp"
#include "tools/campaign/campaign.hpp"

namespace sandhopper {
namespace {

using ::testing::HasSubstr;

std::string refusal(const CampaignFolder& folder, CampaignPlant plant) {
  try {
    std::vector<Finding> notes;
    std::vector<UnstatedNumber> unstated;
    load_belief(folder.path() / "nominal.toml", plant, notes, unstated);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

// The campaign's belief after the entries of one trial.
Belief believed(const std::string& plant, const std::string& model, const std::string& setup) {
  CampaignFolder folder;
  folder.write("nominal.toml", model)
      .write("campaign.toml",
             "plant = \"" + plant + "\"\nmodel = \"nominal.toml\"\n[[trial]]\nfile = \"a.csv\"\n" + setup);
  return load_campaign(folder.path()).trials.at(0).belief;
}

TEST(Belief, LeftOutKeysTakeThePlantsDefault) {
  const auto hopper = std::get<HopperBelief>(default_belief(CampaignPlant::hopper));
  EXPECT_EQ(hopper.terrain.stiffness_N_per_m, 1500.0);
  EXPECT_EQ(hopper.sensors.robot.load_cell_noise_N, 0.3);
  const auto intruder = std::get<IntruderBelief>(default_belief(CampaignPlant::intruder));
  EXPECT_EQ(intruder.foot.radius_m, 0.040);
  EXPECT_EQ(intruder.spread.robot.bed_stiffness_relative, 0.03);
  EXPECT_FALSE(intruder.rig.stiffness_N_per_m.has_value());
  const auto body = std::get<FallingBodyBelief>(default_belief(CampaignPlant::falling_body));
  EXPECT_EQ(body.medium.drag_coefficient, 0.0);
  EXPECT_EQ(body.sensors.robot.load_cell_noise_N, 0.0);
  EXPECT_EQ(body.spread.robot.bed_stiffness_relative, 0.0);
  EXPECT_EQ(std::get<RotaryAxisBelief>(default_belief(CampaignPlant::rotary_axis)).axis.coulomb_friction_Nm,
            0.0);
}

TEST(Belief, EveryPlantsOwnKeysAreRead) {
  const auto body = std::get<FallingBodyBelief>(
      believed("falling_body",
               "gravity_mps2 = 9.8\n[bed]\nsurface_height_m = 0.5\nstiffness_N_per_m = 100\n[body]\n"
               "mass_kg = 7.7\nfrontal_area_m2 = 0.006\nvolume_m3 = 2.5e-3\n[medium]\n"
               "density_kg_per_m3 = 1000\nbuoyancy_factor = 1\nadded_mass_factor = 0.5\n"
               "drag_coefficient = 0.4\nlinear_drag_N_s_per_m = 0.1\n[sensors]\n"
               "accel_range_mps2 = 20\n[spread]\naccel_bias_mps2 = 0.1\n",
               ""));
  EXPECT_EQ(body.bed.stiffness_N_per_m, 100.0);
  EXPECT_EQ(body.medium.added_mass_factor, 0.5);
  EXPECT_EQ(body.sensors.other.accel_range_mps2, 20.0);
  EXPECT_EQ(body.spread.other.accel_bias_mps2, 0.1);
  const auto axis = std::get<RotaryAxisBelief>(
      believed("rotary_axis",
               "[axis]\ninertia_kg_m2 = 0.1\ngravity_torque_Nm = 2.6\nviscous_friction_Nm_s = 0.01\n"
               "coulomb_friction_Nm = 0.02\nfriction_switch_speed_radps = 0.05\ngear_ratio = 6\n"
               "[sensors]\ntorque_bits = 12\n[spread]\ninitial_position_rad = 0.1\n",
               ""));
  EXPECT_EQ(axis.axis.gravity_torque_Nm, 2.6);
  EXPECT_EQ(axis.sensors.other.torque_bits, 12.0);
  const auto foot = std::get<IntruderBelief>(
      believed("intruder",
               "[foot]\nradius_m = 0.03\n[terrain]\nstiffness_per_area_N_per_m3 = 4e5\nexponent = 1.3\n"
               "[rig]\nstiffness_N_per_m = 1e5\n",
               ""));
  EXPECT_EQ(foot.terrain.exponent, 1.3);
  EXPECT_EQ(foot.rig.stiffness_N_per_m, 1e5);
  const auto robot = std::get<HopperBelief>(
      believed("hopper", "[robot]\nbody_mass_kg = 1.2\nrail_coulomb_N = 0\n[terrain]\nrigid = true\n", ""));
  EXPECT_EQ(robot.world().robot.leg.body_mass_kg, 1.2);
  EXPECT_TRUE(robot.world().terrain.rigid);
}

TEST(Belief, AnUnknownKeyIsRefusedWithLineAndCure) {
  CampaignFolder folder;
  folder.write("nominal.toml", "[terrain]\nstifness_N_per_m = 1000\n");
  EXPECT_THAT(
      refusal(folder, CampaignPlant::hopper),
      HasSubstr("nominal.toml:2:1: key 'terrain.stifness_N_per_m' is unknown in [terrain]: did you mean "
                "'stiffness_N_per_m'"));
  folder.write("nominal.toml", "[axis]\ninertia_kg_m2 = 1\n");
  EXPECT_THAT(refusal(folder, CampaignPlant::hopper), HasSubstr("'axis' is unknown"));
  folder.write("nominal.toml", "[body]\nmass_g = 45.9\n");
  EXPECT_THAT(refusal(folder, CampaignPlant::falling_body), HasSubstr("write 'mass_kg = 0.0459'"));
}

TEST(Belief, AnUnknownSensorOrSpreadKeyIsNotedAndLeftOut) {
  CampaignFolder folder;
  folder.write("nominal.toml",
               "[sensors]\nlidar_noise_m = 0.01\nmocap_noise_m = 0.001\n[spread]\nmood = 3\n");
  std::vector<Finding> notes;
  std::vector<UnstatedNumber> unstated;
  const auto belief = std::get<HopperBelief>(
      load_belief(folder.path() / "nominal.toml", CampaignPlant::hopper, notes, unstated));
  EXPECT_EQ(belief.sensors.robot.mocap_noise_m, 0.001);
  ASSERT_EQ(notes.size(), 2u);
  EXPECT_THAT(to_string(notes[0]), HasSubstr("nominal.toml:2:1: sensors.lidar_noise_m"));
  EXPECT_EQ(notes[1].severity, FindingSeverity::note);
}

TEST(Belief, ASensorKeyOfAnotherPlantIsAnsweredWithThatOfThisPlant) {
  CampaignFolder folder;
  folder.write("nominal.toml", "[sensors]\nlaser_noise_m = 0.01\nposition_noise_m = 0.001\n")
      .write("campaign.toml",
             "plant = \"intruder\"\nmodel = \"nominal.toml\"\n[[trial]]\nfile = \"a.csv\"\n");
  const auto campaign = load_campaign(folder.path());
  ASSERT_EQ(campaign.findings.size(), 1U);
  EXPECT_THAT(campaign.findings[0].cure, HasSubstr("plant \"intruder\" has 'mocap_noise_m' for it"));
  const auto unused = unused_key_notes(campaign);
  ASSERT_EQ(unused.size(), 1U);
  EXPECT_THAT(to_string(unused[0]),
              HasSubstr("nominal.toml:3:1: sensors.position_noise_m: is read, but nothing "
                        "is computed with it; plant \"intruder\" has 'mocap_noise_m'"));
  folder.write("nominal.toml", "[sensors]\nmocap_noise_m = 0.01\nposition_noise_m = 0.001\n");
  EXPECT_TRUE(unused_key_notes(load_campaign(folder.path())).empty());
}

TEST(Belief, ASetUpKeyOfTheSameNameTakesItsPlaceInThatTrial) {
  const auto body = std::get<FallingBodyBelief>(
      believed("falling_body", "[body]\nmass_kg = 1.0\n", "mass_kg = 0.0459\ndiameter_m = 0.0427\n"));
  EXPECT_EQ(body.body.mass_kg, 0.0459);
  EXPECT_DOUBLE_EQ(body.body.frontal_area_m2, std::numbers::pi / 4.0 * 0.0427 * 0.0427);
  EXPECT_EQ(std::get<IntruderBelief>(believed("intruder", "", "foot_diameter_m = 0.06\n")).foot.radius_m,
            0.03);
  EXPECT_EQ(std::get<HopperBelief>(believed("hopper", "", "extension_stiffness_N_per_m = 600\n"))
                .controller.extension_stiffness_N_per_m,
            600.0);
}

TEST(Belief, TheReleaseHeightOfATrialIsNotTheSpreadOfReleaseHeights) {
  const auto belief = std::get<HopperBelief>(believed("hopper", "", "release_height_m = 0.0618\n"));
  EXPECT_EQ(belief.spread.robot.release_height_m, 0.0);
}

// A hand throws from anywhere, so heights and speeds of release have a much larger spread than those of a
// robot.
TEST(Belief, AThrowMayStartAnywhere) {
  const auto body = std::get<FallingBodyBelief>(
      believed("falling_body", "[spread]\nrelease_height_m = 0.5\nrelease_speed_mps = 2.0\n", ""));
  EXPECT_EQ(body.spread.robot.release_height_m, 0.5);
  EXPECT_EQ(body.spread.robot.release_speed_mps, 2.0);
  CampaignFolder folder;
  folder.write("nominal.toml", "[spread]\nrelease_speed_mps = -1.0\n");
  EXPECT_THAT(refusal(folder, CampaignPlant::falling_body), HasSubstr("spread.release_speed_mps"));
}

TEST(Belief, AnImpossibleSetUpValueRulesOutThatTrialOnly) {
  CampaignFolder folder;
  folder.write(
      "campaign.toml",
      "plant = \"falling_body\"\n[[trial]]\nfile = \"a.csv\"\nmass_kg = -1\n[[trial]]\nfile = \"b.csv\"\n");
  const auto campaign = load_campaign(folder.path());
  ASSERT_EQ(campaign.trials.size(), 1U);
  ASSERT_EQ(campaign.findings.size(), 1U);
  EXPECT_EQ(campaign.findings[0].line, 4U);
  EXPECT_THAT(campaign.findings[0].what, HasSubstr("out of range"));
}

}  // namespace
}  // namespace sandhopper
