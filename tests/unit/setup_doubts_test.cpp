#include "tools/campaign/setup_doubts.hpp"

#include <gmock/gmock.h>

#include <string>

#include "tests/unit/campaign_folder.hpp"

namespace sandhopper {
namespace {

using testing::AllOf;
using testing::HasSubstr;

struct Loaded {
  std::size_t trials = 0;
  std::string text;  // findings of campaign.toml
};

Loaded load(const std::string& plant, const std::string& setup, const std::string& nominal = "") {
  CampaignFolder folder;
  const std::string model = nominal.empty() ? "" : "model = \"nominal.toml\"\n";
  folder.write("nominal.toml", nominal);
  folder.write("campaign.toml",
               "plant = \"" + plant + "\"\n" + model + "[[trial]]\nfile = \"a.csv\"\n" + setup + "\n");
  const auto campaign = load_campaign(folder.path());
  Loaded loaded{campaign.trials.size(), ""};
  for (const auto& finding : campaign.findings) loaded.text += to_string(finding) + "\n";
  return loaded;
}

struct Case {
  std::string plant, setup, what, cure;
};

TEST(SetupDoubts, NameAKnownQuantityInAnotherUnitWithItsLine) {
  for (const auto& [plant, setup, what, cure] :
       {Case{"intruder", "plate_diameter_mm = 50", "is not read", "write plate_diameter_m = 0.05"},
        Case{"intruder", "impact_speed_mm_s = 20", "is in mm/s", "write impact_speed_mps = 0.02"},
        Case{"intruder", "Plate_Diam_cm = 5", "is not read", "write plate_diameter_m = 0.05"},
        Case{"intruder", "plate_diameter = 0.05", "is not read", "write plate_diameter_m"},
        Case{"intruder", "probe_diameter_mm = 12", "is not read", "write plate_diameter_m = 0.012"},
        Case{"intruder", "plate_area_m2 = 0.0025", "is not read", "write plate_diameter_m = 0.056419"},
        Case{"intruder", "foot_area_cm2 = 25", "is not read", "write plate_diameter_m = 0.056419"},
        Case{"intruder", "plate = \"60 mm\"", "is not read", "write plate_diameter_m = 0.06"},
        Case{"falling_body", "mass_g = 145", "is in g", "write mass_kg = 0.145"},
        Case{"falling_body", "body_mass_g = 145", "is in g", "write mass_kg = 0.145"},
        Case{"rotary_axis", "inertia_g_cm2 = 300", "is in g_cm2", "write inertia_kg_m2 = 3e-05"},
        Case{"hopper", "release_height_cm = 20", "is in cm", "write release_height_m = 0.2"}}) {
    const auto loaded = load(plant, setup);
    EXPECT_EQ(loaded.trials, 0u) << setup;
    EXPECT_THAT(loaded.text, AllOf(HasSubstr("campaign.toml:4:1"), HasSubstr(what), HasSubstr(cure)))
        << setup;
    if (cure.find('=') == std::string::npos) continue;
    const auto cured = load(plant, cure.substr(cure.find(' ') + 1));
    EXPECT_EQ(cured.trials, 1u) << cure << "\n" << cured.text;
  }
}

// A square foot is taken for the disc of its area, which the user states.
TEST(SetupDoubts, NameTheSideOfAFootThatIsNoDisc) {
  const auto loaded = load("intruder", "plate_width_mm = 80");
  EXPECT_EQ(loaded.trials, 0u);
  EXPECT_THAT(loaded.text, HasSubstr("write plate_diameter_m = 0.0902703, of the disc of the same area"));
  EXPECT_EQ(load("intruder", "plate_width_mm = 80\nplate_diameter_m = 0.09").trials, 1u);
}

TEST(SetupDoubts, NameAMisspeltKey) {
  for (const auto& [plant, setup, what, cure] :
       {Case{"intruder", "plate_diamter_m = 0.05", "is not a key", "write plate_diameter_m = 0.05"},
        Case{"intruder", "impact_sped_mps = 0.1", "is not a key", "write impact_speed_mps = 0.1"},
        Case{"intruder", "impact_velocity_mps = 0.1", "is not a key", "write impact_speed_mps = 0.1"},
        Case{"falling_body", "realease_height_m = 0.5", "is not a key", "write release_height_m = 0.5"}}) {
    const auto loaded = load(plant, setup);
    EXPECT_EQ(loaded.trials, 0u) << setup;
    EXPECT_THAT(loaded.text, AllOf(HasSubstr(what), HasSubstr(cure))) << setup;
  }
}

TEST(SetupDoubts, NeedANumberWhereTheKeyIsOne) {
  for (const auto& [plant, setup, what, cure] :
       {Case{"intruder", "plate_diameter_m = \"50 mm\"", "is the text", "write plate_diameter_m = 0.05"},
        Case{"intruder", "plate_diameter_m = \"0.08\"", "is the text", "write plate_diameter_m = 0.08"},
        Case{"intruder", "impact_speed_mps = \"fast\"", "is the text", "write a number: impact_speed_mps = "},
        Case{"falling_body", "mass = \"145 g\"", "is not read", "write mass_kg = 0.145"}}) {
    const auto loaded = load(plant, setup);
    EXPECT_EQ(loaded.trials, 0u) << setup;
    EXPECT_THAT(loaded.text, AllOf(HasSubstr(what), HasSubstr(cure))) << setup;
  }
}

TEST(SetupDoubts, TwoSizesOfOneFootContradict) {
  const auto two = load("intruder", "plate_diameter_m = 0.04\nfoot_radius_m = 0.04");
  EXPECT_EQ(two.trials, 0u);
  EXPECT_THAT(two.text, AllOf(HasSubstr("they contradict each other"), HasSubstr("plate_diameter_m")));
  EXPECT_EQ(load("intruder", "plate_diameter_m = 0.04\nradius_m = 0.04").trials, 0u);
  EXPECT_EQ(load("falling_body", "diameter_m = 0.04\nfrontal_area_m2 = 0.5").trials, 0u);
  // The same size twice, and a rod that carries the plate.
  EXPECT_EQ(load("intruder", "plate_diameter_m = 0.08\nradius_m = 0.04").trials, 1u);
  EXPECT_EQ(load("intruder", "plate_diameter_m = 0.08\nplate_radius_mm = 40").trials, 1u);
  EXPECT_EQ(load("intruder", "plate_diameter_m = 0.08\nrod_diameter_mm = 12").trials, 1u);
}

// A laboratory writes down what it wants; what says the same as nominal.toml does no harm.
TEST(SetupDoubts, LeaveTheLaboratorysOwnKeysAlone) {
  for (const char* setup :
       {"operator = \"A.\"\ntemperature_C = 21.5\nhumidity_percent = 40\nsession = 3\nsample_id = \"b7\"",
        "grain_diameter_um = 300\ncontainer_diameter_m = 0.3\nbead_diameter_mm = 1\nhole_diameter_mm = 6",
        "start_height_m = 0.1\ntarget_depth_m = 0.03\nsurface_height_mm = 3\ncamera_rate_Hz = 240",
        "plate = \"B\"\nfoot = \"steel\"\ncylinder = 3\nbox_area_m2 = 0.2\nbox_width_m = 0.5\nbeam_width_mm "
        "= 20",
        "plate_thickness_mm = 5\nsieve_area_cm2 = 300\nbody_width_m = 0.2",
        "rest_min = 2\nfill_depth_mm = 100\nintrusion_number = 3\nbox_depth_m = 0.2",
        "moving_mass_kg = 0.4\nrig_mass_g = 20\ndepth_m = 0.03\nspeed = \"slow\"\nmass = \"light\"",
        "date = \"2026-11-29\"\nnote = \"50 mm plate\"\nradius_1 = 3\nmass_max_kg = 2.0"})
    EXPECT_EQ(load("intruder", setup).trials, 1u) << setup << "\n" << load("intruder", setup).text;
  EXPECT_EQ(load("intruder", "plate_area_cm2 = 50.27", "[foot]\nradius_m = 0.04\n").trials, 1u);
  EXPECT_EQ(load("intruder", "plate_diameter_mm = 80", "[foot]\nradius_m = 0.04\n").trials, 1u);
  EXPECT_EQ(load("hopper", "rate = 1000").trials, 1u);
  EXPECT_EQ(load("falling_body", "ball_diameter_mm = 70").trials, 1u);  // nothing brakes it
}

TEST(SetupDoubts, AMappingThatIsNotUnderstoodIsNotPassedOver) {
  CampaignFolder folder;
  const auto trials_with = [&](const std::string& offset) {
    folder.write("campaign.toml",
                 "plant = \"intruder\"\n[columns]\nforce_N = { column = \"force_N\", offset = " + offset +
                     " }\n[[trial]]\nfile = \"a.csv\"\n");
    return load_campaign(folder.path());
  };
  EXPECT_EQ(trials_with("5").trials.size(), 1u);
  const auto text = trials_with("\"5\"");
  EXPECT_TRUE(text.trials.empty());
  ASSERT_EQ(text.findings.size(), 1u);
  EXPECT_THAT(to_string(text.findings[0]),
              AllOf(HasSubstr("offset = \"5\" is a text, not a number"), HasSubstr("write offset = 5")));
}

}  // namespace
}  // namespace sandhopper
