#include "tools/diagnose/recordings/given_effects.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "campaign_folder.hpp"
#include "tools/campaign/belief_sources.hpp"
#include "tools/diagnose/model/parameter_names.hpp"

// [effects] of nominal.toml: names that the plant does not have are refused.
namespace sandhopper::diagnose {
namespace {

using ::testing::HasSubstr;

std::string refusal(const std::string& plant, const std::string& effects) {
  CampaignFolder folder;
  folder.write("nominal.toml", "[effects]\n" + effects + "\n")
      .write("campaign.toml",
             "plant = \"" + plant + "\"\nmodel = \"nominal.toml\"\n[[trial]]\nfile = \"a.csv\"\n");
  const auto campaign = load_campaign(folder.path());
  try {
    refuse_unknown_effects(campaign);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(GivenEffects, AKnownEffectIsTaken) {
  EXPECT_EQ(refusal("intruder", "\"load_cell.inertia[force_N]\" = { mass_kg = 0.085 }"), "");
  EXPECT_EQ(refusal("rotary_axis",
                    "\"axis.stribeck\" = { stribeck_torque_Nm = 0.05, stribeck_speed_radps = 0.6 }\n"
                    "\"axis.stribeck#2\" = { stribeck_torque_Nm = 0.01 }\n"
                    "\"clock.skew[torque_Nm]\" = { skew_s = 0.002 }"),
            "");
}

TEST(GivenEffects, AnUnknownNameIsRefusedWithItsLineAndTheNearest) {
  EXPECT_THAT(
      refusal("intruder", "\"load_cell.inertja[force_N]\" = { mass_kg = 0.085 }"),
      HasSubstr("nominal.toml:2:32: no effect of plant \"intruder\" is called 'load_cell.inertja': did "
                "you mean 'load_cell.inertia'?"));
  EXPECT_THAT(refusal("intruder", "\"load_cell.inertia[force_N]\" = { mas_kg = 0.085 }"),
              HasSubstr("'mas_kg' is no parameter of 'load_cell.inertia[force_N]': did you mean 'mass_kg'?"));
  EXPECT_THAT(refusal("rotary_axis", "\"terrain.crater\" = { x = 1.0 }"), HasSubstr("no effect of plant"));
}

// An answer prints the number and its change; [effects] takes either, with the same meaning, and not both.
TEST(GivenEffects, TheNamesOfAnAnswerAreTaken) {
  EXPECT_EQ(refusal("intruder",
                    "\"terrain.depth_power_law\" = { exponent_change = 0.3, reference_depth_m = 0.02 }"),
            "");
  EXPECT_THAT(refusal("intruder", "\"terrain.depth_power_law\" = { exponent_change = 0.3, exponent = 1.3 }"),
              HasSubstr("'exponent' and 'exponent_change' of 'terrain.depth_power_law' are the same"));
  const EffectParameter exponent{.name = "exponent", .base = 1.0};
  EXPECT_DOUBLE_EQ(given_value(exponent, {{"exponent", 1.3}}).value(), 0.3);
  EXPECT_DOUBLE_EQ(given_value(exponent, {{"exponent_change", 0.3}}).value(), 0.3);
  EXPECT_FALSE(given_value(exponent, {{"reference_depth_m", 0.3}}));
  const EffectParameter compliance{.name = "stiffness_N_per_m", .base = 0.001, .power = -1.0};
  EXPECT_EQ(names_in_effects(compliance).size(), 1U) << "its change is printed nowhere";
}

TEST(GivenEffects, StatedEffectsAreListedWithTheirLine) {
  CampaignFolder folder;
  folder.write("nominal.toml", "[effects]\n\"axis.coulomb\" = { coulomb_friction_Nm = 0.012 }\n")
      .write("campaign.toml",
             "plant = \"rotary_axis\"\nmodel = \"nominal.toml\"\n[[trial]]\nfile = \"a.csv\"\n");
  const auto listed = stated_effects(load_campaign(folder.path()));
  ASSERT_EQ(listed.size(), 1U);
  EXPECT_EQ(listed.front(), "effects.\"axis.coulomb\": coulomb_friction_Nm = 0.012 (nominal.toml, line 2)");
  folder.write("nominal.toml", "gravity_mps2 = 9.81\n");
  EXPECT_TRUE(stated_effects(load_campaign(folder.path())).empty());
}

TEST(GivenEffects, ASensorsEffectNeedsItsChannel) {
  EXPECT_THAT(
      refusal("intruder", "\"load_cell.inertia\" = { mass_kg = 0.085 }"),
      HasSubstr("needs the channel of its sensor in brackets: did you mean 'load_cell.inertia[force_N]'?"));
  EXPECT_THAT(refusal("intruder", "\"load_cell.inertia[foot_z_m]\" = { mass_kg = 0.085 }"),
              HasSubstr("'load_cell.inertia[force_N]'"));
  EXPECT_THAT(refusal("rotary_axis", "\"axis.coulomb[torque_Nm]\" = { coulomb_friction_Nm = 0.1 }"),
              HasSubstr("takes no channel"));
}

TEST(Ports, AnAxisHasNoBody) {
  EXPECT_EQ(port_on(PlantKind::rotary_axis, Port::body), Port::axis);
  EXPECT_EQ(port_on(PlantKind::falling_body, Port::body), Port::body);
}

}  // namespace
}  // namespace sandhopper::diagnose
