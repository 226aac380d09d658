#include "tools/campaign/belief_sources.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/campaign_folder.hpp"

// A set-up that states the default's value is the source of that number.
namespace sandhopper {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::string sources(const std::string& plant, const std::string& setup, const std::string& model = "") {
  CampaignFolder folder;
  folder.write("nominal.toml", model)
      .write("campaign.toml", "plant = \"" + plant + "\"\nmodel = \"nominal.toml\"\n[every_trial]\n" + setup +
                                  "\n[[trial]]\nfile = \"a.csv\"\n[[trial]]\nfile = \"b.csv\"\n");
  std::string text;
  for (const auto& number : used_numbers(load_campaign(folder.path())).numbers)
    text += to_string(number) + "\n";
  return text;
}

TEST(BeliefSources, ASetUpWithTheDefaultsValueIsItsSource) {
  EXPECT_THAT(sources("intruder", "plate_diameter_m = 0.08"),
              HasSubstr("foot.radius_m = 0.04 m (set-up of 2 of 2 trials)"));
  EXPECT_THAT(sources("hopper", "plate_diameter_m = 0.08"),
              HasSubstr("robot.foot_radius_m = 0.04 m (set-up of 2 of 2 trials)"));
  EXPECT_THAT(sources("falling_body", "mass_kg = 1.0"),
              HasSubstr("body.mass_kg = 1 kg (set-up of 2 of 2 trials)"));
  EXPECT_THAT(sources("intruder", ""), HasSubstr("foot.radius_m = 0.04 m (default: "));
}

// Two numbers have this name; a set-up states the first.
TEST(BeliefSources, ASetUpStatesOneNumberOfItsName) {
  const auto told = sources("falling_body", "surface_height_m = 0.5");
  EXPECT_THAT(told, HasSubstr("bed.surface_height_m = 0.5 m (set-up of 2 of 2 trials)"));
  EXPECT_THAT(told, HasSubstr("medium.surface_height_m = 100000 m (default: everywhere)"));
  EXPECT_THAT(sources("intruder", "stiffness_N_per_m = 1500.0", "[rig]\nstiffness_N_per_m = 1e5\n"),
              HasSubstr("rig.stiffness_N_per_m = 100000 N/m (nominal.toml, line 2)"));
}

// release_height_m of a trial is no spread.
TEST(BeliefSources, ASetUpStatesNoSpread) {
  EXPECT_THAT(sources("hopper", "release_height_m = 0.05"), Not(HasSubstr("spread.release_height_m")));
}

TEST(BeliefSources, ListsDefaultsOfSensorsThatThePlantUsesOnly) {
  CampaignFolder folder;
  folder.write("campaign.toml", "plant = \"intruder\"\n[[trial]]\nfile = \"a.csv\"\n");
  const auto used = used_numbers(load_campaign(folder.path()));
  EXPECT_THAT(defaults_of_sensors(used), HasSubstr("spread.bed_stiffness_relative = 0.03"));
  EXPECT_THAT(defaults_of_sensors(used), HasSubstr("sensors.load_cell_noise_N = 0.3 N"));
  EXPECT_THAT(defaults_of_sensors(used), Not(HasSubstr("imu_")));
  EXPECT_EQ(defaults_of_sensors({}), "");
}

TEST(BeliefSources, SpeedsWithinWhichDryFrictionChangesItsSignAreListed) {
  const auto silent = sources("hopper", "");
  EXPECT_THAT(silent, HasSubstr("robot.rail_friction_switch_speed_mps = 0.01 m/s (default: smooths the sign; "
                                "without dry friction it does nothing"));
  EXPECT_THAT(silent, HasSubstr("robot.joint_friction_switch_speed_radps = 0.2 rad/s (default: "));
  EXPECT_THAT(sources("hopper", "", "[robot]\nrail_friction_switch_speed_mps = 0.02\n"),
              HasSubstr("robot.rail_friction_switch_speed_mps = 0.02 m/s (nominal.toml, line 2)"));
}

}  // namespace
}  // namespace sandhopper
