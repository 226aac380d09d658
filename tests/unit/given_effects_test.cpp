#include "tools/diagnose/recordings/given_effects.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "campaign_folder.hpp"
#include "tools/diagnose/model/effect.hpp"

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
