#include "tools/campaign/campaign_draft.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <set>

#include "campaign_folder.hpp"
#include "tools/campaign/belief_notes.hpp"
#include "tools/campaign/belief_sources.hpp"
#include "tools/campaign/key_reference.hpp"
#include "tools/campaign/trial_recording.hpp"
#include "tools/terrain/campaign_analysis.hpp"
#include "tools/terrain/strength_curve.hpp"

// Campaign and belief drafted for a foreign file, with the source of each number.
namespace sandhopper {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

struct Drafted {
  CampaignDraft draft;
  Campaign campaign;
  TrialRecording recording;
};

// The campaign that `hop campaign import` writes for a file, read back.
Drafted drafted(CampaignFolder& folder, const std::string& text,
                std::optional<CampaignPlant> plant = std::nullopt) {
  folder.write("rec.csv", text);
  Drafted out;
  out.draft = draft_campaign({folder.path() / "rec.csv"}, plant, folder.path());
  folder.write("campaign.toml", out.draft.campaign_toml).write("nominal.toml", out.draft.nominal_toml);
  out.campaign = load_campaign(folder.path());
  out.recording = read_trial(out.campaign, out.campaign.trials.at(0));
  return out;
}

// The draft's nominal.toml with 0.2 for every number that it leaves to the user ("?").
std::string with_numbers(std::string nominal) {
  const std::string unknown = "= \"?\"";
  for (auto at = nominal.find(unknown); at != std::string::npos; at = nominal.find(unknown))
    nominal.replace(at, unknown.size(), "= 0.2");
  return nominal;
}

std::string rows(const std::string& header, char separator, int columns) {
  std::string text = header;
  for (int i = 0; i < 40; ++i)
    for (int c = 0; c < columns; ++c)
      text +=
          fmt::format("{:.4f}{}", c == 0 ? 10.0 * i : 0.3 * i + 0.1 * c, c + 1 < columns ? separator : '\n');
  return text;
}

TEST(CampaignDraft, APlateOfATestingMachine) {
  CampaignFolder folder;
  auto text = rows("Machine;X\n\nZeit;Kraft;Weg\nms;kN;mm\n", ';', 3);
  std::replace(text.begin() + 12, text.end(), '.', ',');
  const auto got = drafted(folder, text);
  EXPECT_EQ(got.draft.plant, CampaignPlant::intruder);
  EXPECT_THAT(got.draft.campaign_toml, HasSubstr("file = \"rec.csv\""));
  ASSERT_FALSE(got.recording.usable()) << "a way that grows downward";
  const std::string way = "foot_z_m = { column = \"Weg\", unit = \"mm\", scale = -0.001 }";
  EXPECT_THAT(find(got.recording, FindingKind::implausible)->cure, HasSubstr(way));
  auto corrected = got.draft.campaign_toml;
  const std::string drafted_way = "foot_z_m = { column = \"Weg\", unit = \"mm\" }";
  ASSERT_NE(corrected.find(drafted_way), std::string::npos) << corrected;
  corrected.replace(corrected.find(drafted_way), drafted_way.size(), way);
  folder.write("campaign.toml", corrected).write("nominal.toml", with_numbers(got.draft.nominal_toml));
  const auto campaign = load_campaign(folder.path());
  const auto recording = read_trial(campaign, campaign.trials.at(0));
  ASSERT_TRUE(recording.usable()) << to_string(recording.findings.front());
  EXPECT_NEAR(recording.t_s[1], 0.01, 1e-12);
  EXPECT_NEAR(recording.channel("force_N")[2], 700.0, 1e-9);
  EXPECT_NEAR(recording.channel("foot_z_m")[2], -0.8e-3, 1e-12);
}

TEST(CampaignDraft, AWayThatGrowsDownwardAndBeginsAboveTheSurface) {
  CampaignFolder folder;
  std::string text = "Zeit [s];Weg [mm];Kraft [N]\n";
  for (int i = 0; i <= 72; ++i) text += fmt::format("{};{};{}\n", 0.1 * i, i - 12, std::max(0, i - 12));
  const auto got = drafted(folder, text);
  ASSERT_FALSE(got.recording.usable());
  EXPECT_THAT(find(got.recording, FindingKind::implausible)->what,
              HasSubstr("is highest where the force is largest"));
}

TEST(CampaignDraft, AnAxisInDegreesAndTurns) {
  CampaignFolder folder;
  const auto got = drafted(folder, rows("Time (ms),Angle [deg],Speed [rpm],Torque [N·m],Temp (C)\n", ',', 5));
  EXPECT_EQ(got.draft.plant, CampaignPlant::rotary_axis);
  EXPECT_THAT(got.draft.campaign_toml,
              HasSubstr("position_rad = { column = \"Angle [deg]\", unit = \"deg\" }"));
  EXPECT_THAT(got.draft.campaign_toml, HasSubstr("# not used: column \"Temp (C)\""));
  EXPECT_TRUE(got.recording.has("torque_Nm"));
}

TEST(CampaignDraft, ADroppedBodyAndADepthCountedDownward) {
  CampaignFolder first, second;
  EXPECT_EQ(drafted(first, rows("t_s,Height (mm)\n", ',', 2), CampaignPlant::falling_body).draft.plant,
            CampaignPlant::falling_body);
  const auto depth = drafted(second, rows("time,Force (N),Sinkage (mm)\n", ',', 3));
  EXPECT_THAT(depth.draft.campaign_toml,
              HasSubstr("foot_z_m = { column = \"Sinkage (mm)\", scale = -0.001 }"));
}

TEST(CampaignDraft, APlantThatTheColumnsDoNotTellIsAsked) {
  for (const std::string header : {"t,y\n", "t,x (mm)\n"}) {
    CampaignFolder folder;
    const auto text = rows(header, ',', 2);
    EXPECT_THROW(drafted(folder, text), PlantNotTold) << header;
    EXPECT_EQ(drafted(folder, text, CampaignPlant::falling_body).draft.plant, CampaignPlant::falling_body);
  }
  CampaignFolder hops;
  EXPECT_EQ(drafted(hops, rows("t_s,tof_height_m\n", ',', 2)).draft.plant, CampaignPlant::hopper);
}

// A body that falls by 0.8 m; `sign` -1: height counted downward.
TrialRecording dropped(double sign, const std::string& how, const std::string& set_up,
                       double speed_mps = 0.0) {
  CampaignFolder folder;
  std::string text = "t_s,h\n";
  for (int i = 0; i < 40; ++i) {
    const double t = 0.01 * i, h = 0.8 + speed_mps * t - 0.5 * 9.81 * t * t;
    text += fmt::format("{:.3f},{:.5f}\n", t, 1000.0 * sign * h);
  }
  folder.write("a.csv", text)
      .write("campaign.toml", "plant = \"falling_body\"\n[columns]\nheight_m = { column = \"h\", " + how +
                                  " }\n[[trial]]\nfile = \"a.csv\"\nkind = \"drop\"\n" + set_up);
  const auto campaign = load_campaign(folder.path());
  return read_trial(campaign, campaign.trials.at(0));
}

TEST(CampaignDraft, AHeightThatRisesInADropCountsDownward) {
  const std::string way = "height_m = { column = \"h\", unit = \"mm\", scale = -0.001 }";
  EXPECT_TRUE(dropped(1.0, "unit = \"mm\"", "").usable());
  const auto wrong = dropped(-1.0, "unit = \"mm\"", "");
  ASSERT_FALSE(wrong.usable());
  EXPECT_THAT(find(wrong, FindingKind::implausible)->cure, HasSubstr(way));
  EXPECT_TRUE(dropped(-1.0, "unit = \"mm\", scale = -0.001", "").usable());
  EXPECT_EQ(find(dropped(-1.0, "unit = \"mm\", scale = -0.001", ""), FindingKind::implausible), nullptr);
  EXPECT_TRUE(dropped(1.0, "unit = \"mm\"", "release_speed_mps = 4.0\n", 4.0).usable());
  EXPECT_FALSE(dropped(1.0, "unit = \"mm\"", "release_speed_mps = 0.0\n", 4.0).usable());
}

// A telephone in free fall; `down`: its axis along the fall.
std::string phone_log(int down) {
  std::string text =
      "\"Time (s)\",\"Acceleration x (m/s^2)\",\"Acceleration y (m/s^2)\",\"Acceleration z (m/s^2)\","
      "\"Absolute acceleration (m/s^2)\"\n";
  for (int i = 0; i < 40; ++i) {
    const double along = i < 20 ? 9.8 : 0.1, across = 0.05 * (i % 3);
    text += fmt::format("{:.3f}", 0.01 * i);
    for (int axis = 0; axis < 3; ++axis) text += fmt::format(",{:.3f}", axis == down ? along : across);
    text += fmt::format(",{:.3f}\n", along);
  }
  return text;
}

TEST(CampaignDraft, TheAxisOfAPhoneIsTheOneThatReadsMostAndIsSaid) {
  for (const auto& [down, letter] : {std::pair{0, "x"}, {1, "y"}, {2, "z"}}) {
    CampaignFolder folder;
    const auto got = drafted(folder, phone_log(down), CampaignPlant::falling_body);
    const auto taken = fmt::format("Acceleration {} (m/s^2)", letter);
    EXPECT_THAT(got.draft.campaign_toml,
                HasSubstr(fmt::format("\naccel_mps2 = {{ column = \"{}\", unit = \"m/s^2\" }}", taken)));
    const auto said = fmt::format("{}", fmt::join(got.draft.said, "\n"));
    EXPECT_THAT(said, HasSubstr(fmt::format("axis {} of three (x, y, z)", letter)));
    EXPECT_THAT(said, HasSubstr("name another column"));
    EXPECT_THAT(got.draft.campaign_toml, HasSubstr(fmt::format("# accel_mps2: axis {} of three", letter)));
    EXPECT_THAT(got.draft.campaign_toml, HasSubstr("9.8 m/s2 at rest"));
    ASSERT_TRUE(got.recording.has("accel_mps2"));
    EXPECT_EQ(got.recording.channel("accel_mps2")[0], 9.8);
  }
}

TEST(CampaignDraft, OneColumnIsNoAxisOfThree) {
  CampaignFolder folder;
  const auto got = drafted(folder, rows("Time (s),Acceleration x (m/s^2),Acceleration y (m/s^2)\n", ',', 3),
                           CampaignPlant::falling_body);
  EXPECT_THAT(fmt::format("{}", fmt::join(got.draft.said, "\n")), Not(HasSubstr("of three")));
  EXPECT_THAT(got.draft.campaign_toml, Not(HasSubstr("of three")));
}

TEST(CampaignDraft, ASpreadsheetIsRefusedWithTheWayOut) {
  CampaignFolder folder;
  folder.write("rec.xlsx", "PK\x03\x04 and so on");
  try {
    draft_campaign({folder.path() / "rec.xlsx"}, std::nullopt, folder.path());
    FAIL() << "not refused";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("CSV UTF-8"));
  }
}

TEST(CampaignDraft, NominalHoldsEveryKeyThatThePlantUsesAndStatesNoPhysics) {
  for (const auto plant : {CampaignPlant::hopper, CampaignPlant::intruder, CampaignPlant::falling_body,
                           CampaignPlant::rotary_axis}) {
    CampaignFolder folder;
    const auto text = draft_nominal(plant);
    folder.write("nominal.toml", text);
    std::vector<Finding> notes;
    std::vector<UnstatedNumber> unstated;
    load_belief(folder.path() / "nominal.toml", plant, notes, unstated);
    EXPECT_TRUE(notes.empty());
    EXPECT_FALSE(unstated.empty()) << name_of(plant);
    if (plant == CampaignPlant::intruder) {
      EXPECT_THAT(text, HasSubstr("# added_mass_factor = 0.0")) << "what is not stated";
    }
    std::set<std::string> of_this_plant;
    for (const auto& key : belief_keys(plant))
      if (key.used) of_this_plant.insert(key.key);
    for (const auto& key : belief_keys(plant)) {
      const bool is_written = text.find("\n" + key.key + " = ") != std::string::npos ||
                              text.find("\n# " + key.key + " = ") != std::string::npos;
      EXPECT_EQ(is_written, of_this_plant.contains(key.key)) << name_of(plant) << ": " << key.path();
    }
  }
}

TEST(CampaignDraft, WhatOnlyTheOwnerKnowsIsAskedFor) {
  CampaignFolder folder;
  const auto got = drafted(folder, rows("t_s,Height (mm)\n", ',', 2), CampaignPlant::falling_body);
  EXPECT_THAT(got.draft.nominal_toml, HasSubstr("\nmass_kg = \"?\""));
  EXPECT_THAT(got.draft.nominal_toml, HasSubstr("\ngravity_mps2 = 9.8"));
  std::string told;
  for (const auto& finding : got.recording.findings) told += to_string(finding) + "\n";
  const auto before = got.draft.nominal_toml.substr(0, got.draft.nominal_toml.find("\nmass_kg") + 1);
  EXPECT_THAT(told, HasSubstr(fmt::format("body.mass_kg = \"?\" in line {}: ",
                                          1 + std::count(before.begin(), before.end(), '\n'))));
  EXPECT_THAT(told, HasSubstr("write your own number"));
  EXPECT_FALSE(got.recording.usable());
  folder.write("nominal.toml", with_numbers(got.draft.nominal_toml));
  const auto campaign = load_campaign(folder.path());
  EXPECT_TRUE(campaign.findings.empty());
  for (const auto& finding : read_trial(campaign, campaign.trials.at(0)).findings)
    EXPECT_THAT(finding.what, Not(HasSubstr("write your own number")));
  EXPECT_TRUE(missing_numbers(campaign).empty());
  EXPECT_EQ(numbers_of(campaign.belief)["body.mass_kg"], 0.2);
}

TEST(CampaignDraft, AHopperIsAskedForEachNumberThatDecidesItsAnswer) {
  const auto text = draft_nominal(CampaignPlant::hopper);
  for (const auto keys : {hopper_keys(), hopper_controller_keys()})
    for (const auto key : keys)
      EXPECT_THAT(text, HasSubstr(fmt::format("\n{} = \"?\"", key.substr(key.rfind('.') + 1))));
  EXPECT_THAT(text, HasSubstr("\n# rail_coulomb_N = 0.0"));
  const auto commanded = draft_nominal(CampaignPlant::hopper, true);
  EXPECT_THAT(commanded, HasSubstr("\n# flight_stiffness_N_per_m = "));
  EXPECT_THAT(commanded, HasSubstr("\nbody_mass_kg = \"?\""));
  CampaignFolder folder;
  folder.write("nominal.toml", "[robot]\nbody_mass_kg = 2.4\n")
      .write("campaign.toml",
             "plant = \"hopper\"\nmodel = \"nominal.toml\"\n[columns]\nt_s = \"t\"\n[[trial]]\nfile = "
             "\"a.csv\"\n");
  const auto missing = missing_numbers(load_campaign(folder.path()));
  ASSERT_EQ(missing.size(), 1U);
  EXPECT_EQ(missing.front().severity, FindingSeverity::note);
  EXPECT_THAT(missing.front().what, HasSubstr("robot.foot_mass_kg"));
  EXPECT_THAT(missing.front().what, Not(HasSubstr("body_mass_kg")));
}

TEST(CampaignDraft, TwoAnglesAndTwoCurrentsAreALeg) {
  CampaignFolder leg, axis;
  EXPECT_EQ(drafted(leg, rows("t (s),hipL [deg],hipR [deg],iqL [A],iqR [A]\n", ',', 5)).draft.plant,
            CampaignPlant::hopper);
  EXPECT_EQ(drafted(axis, rows("t (s),angle [deg],iq [A]\n", ',', 3)).draft.plant,
            CampaignPlant::rotary_axis);
}

TEST(CampaignDraft, ColumnsThatFitAsWellAreNamed) {
  CampaignFolder folder;
  const auto got = drafted(folder, rows("Time (s),Clock (ms),Depth (mm),Load 1 (N),Load 2 (N)\n", ',', 5));
  std::string said;
  for (const auto& line : got.draft.said) said += line + "\n";
  EXPECT_THAT(said, HasSubstr("t_s is column \"Time (s)\"; column \"Clock (ms)\" fits as well"));
  EXPECT_THAT(said,
              HasSubstr("force_N: column \"Load 2 (N)\" fits as well; to take it, name it in [columns]"));
  EXPECT_THAT(got.draft.campaign_toml, HasSubstr("# force_N: column \"Load 2 (N)\" fits as well"));
  EXPECT_THAT(said, Not(HasSubstr("foot_z_m: column")));
}

// All verbs read trials by read_trial(), so none of them computes with the default of such a number.
TEST(CampaignDraft, AnUnstatedNumberRulesOutTheTrialsThatDoNotStateIt) {
  CampaignFolder folder;
  std::string press = "t_s,foot_z_m,force_N\n";
  for (int i = 0; i < 40; ++i) press += fmt::format("{:.2f},{:.4f},{:.2f}\n", 0.1 * i, -5e-4 * i, 0.5 * i);
  folder.write("nominal.toml", "[terrain]\nstiffness_N_per_m = \"?\"\n[foot]\nradius_m = \"?\"\n")
      .write("campaign.toml",
             "plant = \"intruder\"\nmodel = \"nominal.toml\"\n[every_trial]\nkind = \"press\"\n"
             "[[trial]]\nfile = \"a.csv\"\n[[trial]]\nfile = \"a.csv\"\nplate_diameter_m = 0.08\n"
             "[[trial]]\nfile = \"a.csv\"\nradius_m = \"?\"\n")
      .write("a.csv", press);
  const auto campaign = load_campaign(folder.path());
  ASSERT_EQ(campaign.trials.size(), 2U) << "\"?\" in a trial is refused as well";
  EXPECT_THAT(campaign.findings.at(0).what, HasSubstr("write your own number"));
  for (const auto& trial : campaign.trials) EXPECT_FALSE(read_trial(campaign, trial).usable());
  const auto results = analyse_campaign(campaign, {});
  EXPECT_FALSE(results.results.at(0).usable);
  EXPECT_TRUE(results.results.at(1).usable) << "the ground's stiffness is looked for, not used";
  std::string told;
  for (const auto& finding : results.results.at(1).findings) told += to_string(finding) + "\n";
  EXPECT_THAT(told, HasSubstr("terrain.stiffness_N_per_m = \"?\" in line 2: is not needed here"));
  EXPECT_THAT(told, Not(HasSubstr("foot.radius_m")));
  std::string used;
  for (const auto& number : used_numbers(campaign).numbers) used += to_string(number) + "\n";
  EXPECT_THAT(used, HasSubstr("foot.radius_m = 0.04 m (set-up of 1 of 2 trials)"));
  EXPECT_THAT(used, Not(HasSubstr("terrain.stiffness_N_per_m"))) << "nobody stated it";
  EXPECT_EQ(believed_stiffness_N_per_m(campaign.trials.at(1)), 0.0) << "no default in its place";
}

TEST(CampaignDraft, ANeededKeyThatIsMissingIsAFinding) {
  CampaignFolder folder;
  const std::string trial = "plant = \"falling_body\"\n[[trial]]\nfile = \"a.csv\"\n";
  folder.write("campaign.toml", trial);
  const auto missing = missing_numbers(load_campaign(folder.path()));
  ASSERT_EQ(missing.size(), 1U);
  EXPECT_EQ(missing.front().channel, "body.mass_kg");
  folder.write("campaign.toml", trial + "mass_kg = 1.0\n");
  EXPECT_TRUE(missing_numbers(load_campaign(folder.path())).empty()) << "stated by every trial";
  folder
      .write("nominal.toml",
             "[foot]\nradius_m = 0.03\n[terrain]\nstiffness_per_area_N_per_m3 = 0.85e6\nexponent = 1.0\n")
      .write("campaign.toml",
             "plant = \"intruder\"\nmodel = \"nominal.toml\"\n[[trial]]\nfile = \"a.csv\"\n");
  EXPECT_TRUE(missing_numbers(load_campaign(folder.path())).empty()) << "stiffness per area stands for it";
}

TEST(BeliefSources, EveryNumberHasItsSource) {
  CampaignFolder folder;
  folder.write("nominal.toml", "gravity_mps2 = 9.81\n[axis]\ninertia_kg_m2 = 0.1\ngravity_torque_Nm = 2.0\n")
      .write("campaign.toml",
             "plant = \"rotary_axis\"\nmodel = \"nominal.toml\"\n[[trial]]\nfile = "
             "\"a.csv\"\n[[trial]]\nfile = \"b.csv\"\n"
             "inertia_kg_m2 = 0.2\n");
  std::string text;
  for (const auto& number : used_numbers(load_campaign(folder.path())).numbers)
    text += to_string(number) + "\n";
  EXPECT_THAT(text, HasSubstr("axis.gravity_torque_Nm = 2 N m (nominal.toml, line 4)"));
  EXPECT_THAT(text, HasSubstr("axis.inertia_kg_m2 = 0.1 to 0.2 kg m^2 (set-up of 1 of 2 trials)"));
  EXPECT_THAT(text, HasSubstr("axis.friction_switch_speed_radps = 0.02 rad/s (default: "));
  EXPECT_THAT(text, Not(HasSubstr("sensors.")));
}

TEST(BeliefSources, NoPhysicsThatNobodyStated) {
  CampaignFolder folder;
  folder.write("nominal.toml", "[terrain]\nstiffness_N_per_m = 1200.0\nbulk_density_kg_per_m3 = 1500.0\n");
  std::vector<Finding> notes;
  std::vector<UnstatedNumber> unstated;
  for (const auto plant : {CampaignPlant::intruder, CampaignPlant::hopper}) {
    auto numbers = numbers_of(load_belief(folder.path() / "nominal.toml", plant, notes, unstated));
    EXPECT_EQ(numbers["terrain.added_mass_factor"], 0.0);
    EXPECT_EQ(numbers["terrain.drag_factor"], 0.0);
    EXPECT_EQ(numbers["terrain.unloading_stiffness_ratio"], 1.0);
    EXPECT_EQ(numbers["terrain.unloading_damping_ratio"], 0.0);
    EXPECT_EQ(numbers["robot.rail_coulomb_N"], 0.0);
    EXPECT_EQ(numbers["robot.joint_coulomb_Nm"], 0.0);
  }
}

// Without a `model`, no number that is assumed may be listed with the reason "not assumed".
TEST(BeliefSources, NoModelAssumesNothing) {
  for (const std::string plant : {"intruder", "hopper"}) {
    CampaignFolder folder;
    folder.write("campaign.toml", "plant = \"" + plant + "\"\n[[trial]]\nfile = \"a.csv\"\n");
    const auto campaign = load_campaign(folder.path());
    auto numbers = numbers_of(campaign.belief);
    EXPECT_EQ(numbers["terrain.added_mass_factor"], 0.0) << plant;
    EXPECT_EQ(numbers["terrain.unloading_stiffness_ratio"], 1.0) << plant;
    for (const auto& number : used_numbers(campaign).numbers)
      EXPECT_THAT(to_string(number), Not(HasSubstr("default: 0: not assumed"))) << plant;
  }
}

}  // namespace
}  // namespace sandhopper
