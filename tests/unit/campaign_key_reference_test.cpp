#include <gtest/gtest.h>

#include <set>

#include "tools/campaign/belief.hpp"
#include "tools/campaign/key_meanings.hpp"
#include "tools/campaign/key_reference.hpp"

namespace sandhopper {
namespace {

constexpr std::array kPlants{CampaignPlant::hopper, CampaignPlant::intruder, CampaignPlant::falling_body,
                             CampaignPlant::rotary_axis};

TEST(CampaignKeyReference, EveryKeyOfEveryPlantHasAMeaningAUnitAndADefault) {
  for (const auto plant : kPlants)
    for (const auto& key : belief_keys(plant)) {
      EXPECT_FALSE(key.meaning.empty())
          << name_of(plant) << ": " << key.path() << " has no entry in tools/campaign/key_meanings";
      EXPECT_FALSE(key.unit.empty()) << key.path();
      EXPECT_FALSE(key.default_value.empty()) << key.path();
    }
}

TEST(CampaignKeyReference, NoMeaningIsLeftOfAKeyThatIsGone) {
  std::set<std::string, std::less<>> keys;
  for (const auto plant : kPlants)
    for (const auto& key : belief_keys(plant)) keys.insert(key.path());
  for (const auto meanings : {model_key_meanings(), sensor_key_meanings()})
    for (const auto& entry : meanings) EXPECT_TRUE(keys.contains(entry.path)) << entry.path;
}

TEST(CampaignKeyReference, EveryChannelHasAMeaning) {
  for (const auto plant : kPlants)
    for (const auto& channel : channel_entries(plant)) EXPECT_FALSE(channel.meaning.empty()) << channel.name;
}

TEST(CampaignKeyReference, DefaultsAndUnitsAreThoseOfTheStructs) {
  const auto find = [](CampaignPlant plant, std::string_view path) {
    for (auto& key : belief_keys(plant))
      if (key.path() == path) return key;
    return BeliefKey{};
  };
  EXPECT_EQ(find(CampaignPlant::rotary_axis, "axis.viscous_friction_Nm_s").unit, "N m s");
  EXPECT_EQ(find(CampaignPlant::falling_body, "body.frontal_area_m2").unit, "m^2");
  EXPECT_EQ(find(CampaignPlant::intruder, "rig.stiffness_N_per_m").default_value, "not set");
  EXPECT_EQ(find(CampaignPlant::hopper, "terrain.stiffness_N_per_m").default_value, "1500");
  EXPECT_FALSE(find(CampaignPlant::rotary_axis, "sensors.tof_rate_Hz").of_this_plant);
  EXPECT_TRUE(find(CampaignPlant::hopper, "robot.upper_link_inertia_kg_m2").is_needed);
  EXPECT_FALSE(find(CampaignPlant::hopper, "robot.rail_coulomb_N").is_needed);
  EXPECT_FALSE(find(CampaignPlant::falling_body, "sensors.pressure_noise_Pa").used);
  EXPECT_TRUE(find(CampaignPlant::falling_body, "sensors.height_noise_m").used);
  EXPECT_EQ(find(CampaignPlant::falling_body, "body.mass_kg").meaning, meaning_of_key("body.mass_kg"));
  EXPECT_TRUE(meaning_of_key("body.colour").empty());
}

}  // namespace
}  // namespace sandhopper
