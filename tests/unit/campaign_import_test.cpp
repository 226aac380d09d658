#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "campaign_folder.hpp"
#include "tools/campaign/belief_sources.hpp"
#include "tools/campaign/campaign_draft.hpp"
#include "tools/campaign/trial_recording.hpp"
#include "tools/terrain/strength_curve.hpp"

// Drafts of `hop campaign import`, and its words for a file that it cannot read by itself.
namespace sandhopper {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

CampaignDraft drafted(const std::string& text, std::optional<CampaignPlant> plant = std::nullopt) {
  CampaignFolder folder;
  folder.write("rec.csv", text);
  return draft_campaign({folder.path() / "rec.csv"}, plant, folder.path());
}

TEST(CampaignImport, AGermanTraceBelowItsFactsIsRead) {
  std::string text =
      "Regler DD-140;Firmware 3.12;Trace\nDatum;14.03.2023;Uhrzeit;10:50\nVersuch;1;Sinus 0,5 Hz\n"
      "Abtastrate;500;Hz\nGeber;16384;Inkremente\n\n"
      "Zeit [ms];Winkel [Grad];Drehzahl [U/min];Drehmoment [Nm]\n";
  for (int i = 0; i < 30; ++i) text += fmt::format("{},0;-0,{};0,{};0,01\n", 2 * i, i + 10, i);
  const auto draft = drafted(text);
  EXPECT_EQ(draft.plant, CampaignPlant::rotary_axis);
  EXPECT_THAT(draft.wrong, IsEmpty());
  for (const std::string line : {"header_line = 7", "t_s = { column = \"Zeit [ms]\", unit = \"ms\" }",
                                 "position_rad = { column = \"Winkel [Grad]\", unit = \"Grad\" }",
                                 "velocity_radps = { column = \"Drehzahl [U/min]\", unit = \"U/min\" }",
                                 "torque_Nm = { column = \"Drehmoment [Nm]\", unit = \"Nm\" }"})
    EXPECT_THAT(draft.campaign_toml, HasSubstr(line));
}

std::string rows(const std::string& header, int columns);

TEST(CampaignImport, ASpeedBehindASlashIsNoSecondTime) {
  const auto draft = drafted(rows("Time/s;Angle/rad;AngVel/rad/s", 3));
  EXPECT_EQ(draft.plant, CampaignPlant::rotary_axis);
  EXPECT_THAT(draft.campaign_toml,
              HasSubstr("velocity_radps = { column = \"AngVel/rad/s\", unit = \"rad/s\" }"));
  EXPECT_THAT(fmt::format("{}", fmt::join(draft.said, "\n")), Not(HasSubstr("fits as well")));
}

std::string rows(const std::string& header, int columns) {
  std::string text = header + "\n";
  for (int i = 0; i < 20; ++i)
    for (int c = 0; c < columns; ++c) text += fmt::format("{}{}", i + 0.25 * c, c + 1 < columns ? ';' : '\n');
  return text;
}

TEST(CampaignImport, GermanNamesWithoutUnitsTellThePlant) {
  EXPECT_EQ(drafted(rows("Zeit;Winkel;Drehzahl", 3)).plant, CampaignPlant::rotary_axis);
  EXPECT_EQ(drafted(rows("Zeit;Kraft;Eindringtiefe", 3)).plant, CampaignPlant::intruder);
  EXPECT_EQ(drafted(rows("Zeit;H\xC3\xB6he", 2)).plant, CampaignPlant::falling_body);
  const auto spoken = drafted(rows("Zeit (Sek);n (Umdr./min);w (Grad/s)", 3));
  EXPECT_THAT(spoken.campaign_toml, HasSubstr("velocity_radps = { column = \"n (Umdr./min)\""));
}

TEST(CampaignImport, DutchFrenchSpanishAndItalianNamesTellThePlant) {
  const auto drop = drafted(rows("proef;beeld;tijd;hoogte", 4));
  EXPECT_EQ(drop.plant, CampaignPlant::falling_body);
  EXPECT_THAT(drop.campaign_toml,
              AllOf(HasSubstr("t_s = { column = \"tijd\""), HasSubstr("height_m = { column = \"hoogte\"")));
  EXPECT_EQ(drafted(rows("temps;hauteur;vitesse", 3)).plant, CampaignPlant::falling_body);
  EXPECT_EQ(drafted(rows("tijd;kracht;diepte", 3)).plant, CampaignPlant::intruder);
  EXPECT_EQ(drafted(rows("tiempo;fuerza;profundidad", 3)).plant, CampaignPlant::intruder);
  EXPECT_EQ(drafted(rows("tempo;angolo;coppia", 3)).plant, CampaignPlant::rotary_axis);
  EXPECT_EQ(drafted(rows("tijd;hoek;koppel", 3)).plant, CampaignPlant::rotary_axis);
  // A French torque, "couple", is told by its unit alone: a thermocouple is none.
  EXPECT_EQ(drafted(rows("time;force;thermocouple 1;thermocouple 2", 4)).plant, CampaignPlant::intruder);
}

TEST(CampaignImport, TheFolderGivesTheCampaignItsName) {
  CampaignFolder folder;
  folder.write("Versuch_01.csv", rows("Zeit;Kraft;Tiefe", 3));
  const auto draft = draft_campaign({folder.path() / "Versuch_01.csv"}, std::nullopt, folder.path());
  EXPECT_THAT(draft.campaign_toml, HasSubstr("name  = \"" + folder.path().filename().string() + "\""));
}

TEST(CampaignImport, ATableWhosePlantIsNotClearIsDescribed) {
  try {
    drafted("mass_A;;\n" + rows("t;x (cm);y", 3));
    FAIL() << "a plant was taken";
  } catch (const PlantNotTold& error) {
    EXPECT_THAT(error.seen, Contains("3 columns, with the names in line 2:"));
    EXPECT_THAT(error.seen, Contains("  \"x (cm)\": unit cm, first value 0.25"));
    EXPECT_THAT(error.seen, Contains("  \"y\": no unit, first value 0.5"));
    EXPECT_THAT(error.seen, Contains(HasSubstr("--plant falling_body a body that falls")));
    EXPECT_THAT(error.seen, Contains(HasSubstr("a height or an acceleration")));
  }
}

std::string said(const CampaignDraft& draft) { return fmt::format("{}", fmt::join(draft.said, "\n")); }

TEST(CampaignImport, ATimeAndAHeightAloneAreAFallingBody) {
  for (const std::string header : {"t_s;y_cm", "t_us;az_g", "image;temps (ms);position y (mm)"}) {
    const auto draft = drafted(rows(header, header.front() == 'i' ? 3 : 2));
    EXPECT_EQ(draft.plant, CampaignPlant::falling_body) << header;
    EXPECT_THAT(said(draft), HasSubstr("alone fit no other plant; --plant says another")) << header;
  }
  for (const std::string header : {"t_s;x_cm", "t_s;mass_g", "t_s;y_cm;z_cm"})
    EXPECT_THROW(drafted(rows(header, header.size() > 10 ? 3 : 2)), PlantNotTold) << header;
  try {
    drafted(rows("t_s;y", 2));
    FAIL() << "a plant was taken";
  } catch (const PlantNotTold& error) {
    EXPECT_THAT(error.seen,
                Contains("falling_body fits if \"y\" is its height_m: then give --plant falling_body"));
  }
}

// `header` has the ticks of a clock first and a time in its third column.
std::string flight(const std::string& header) {
  std::string text = header + "\n";
  for (int i = 0; i < 20; ++i)
    text += fmt::format("{},{},{:.2f},{:.3f},{:.2f}\n", 410290 + 60 * i + i % 3, 14368 + 2 * i + i % 2,
                        0.06 * i, 4.0 * i - 0.02 * i * i, 70.0 - 0.6 * i);
  return text;
}

TEST(CampaignImport, AHeightBesideItsSpeedIsAFallingBody) {
  const auto draft = drafted(flight("useless,time(not s),time aprox (s),z (m),v (m/s)"));
  EXPECT_EQ(draft.plant, CampaignPlant::falling_body);
  EXPECT_THAT(said(draft), HasSubstr("a time, a height (\"z (m)\") and a speed alone fit no other plant"));
  EXPECT_THAT(draft.campaign_toml, HasSubstr("t_s = { column = \"time aprox (s)\", unit = \"s\" }"));
  EXPECT_THAT(draft.campaign_toml, HasSubstr("height_m = { column = \"z (m)\", unit = \"m\" }"));
  EXPECT_THROW(drafted(flight("useless,time(not s),time (s),x (m),v (m/s)")), PlantNotTold) << "a stage";
  EXPECT_THROW(drafted(flight("useless,time(not s),time (s),z (m),x (m)")), PlantNotTold) << "two axes";
  const auto first =
      drafted(flight("tick,time,reaction_time (s),z (m),v (m/s)"), CampaignPlant::falling_body);
  EXPECT_THAT(first.campaign_toml, HasSubstr("t_s = { column = \"time\", unit = \"?\" }"));
}

TEST(CampaignImport, ASetPointIsNoMeasurement) {
  for (const std::string name : {"consigne_deg", "Sollwinkel [deg]", "angle_ref_deg", "posGoal (deg)",
                                 "angle_target_deg", "demand (deg)"}) {
    const auto draft = drafted(rows("t_ms;" + name + ";angle_deg", 3));
    EXPECT_THAT(draft.campaign_toml,
                HasSubstr("\nposition_rad = { column = \"angle_deg\", unit = \"deg\" }"));
    EXPECT_THAT(said(draft), Not(HasSubstr("fits as well"))) << name;
    const auto alone = drafted(rows("t_ms;" + name, 2), CampaignPlant::rotary_axis);
    EXPECT_THAT(alone.campaign_toml, HasSubstr("# position_rad = { column = \"NAME\"")) << name;
  }
  const auto measured = drafted(rows("t_ms;reflected angle_deg", 2));
  EXPECT_THAT(measured.campaign_toml, HasSubstr("\nposition_rad = { column = \"reflected"));
}

TEST(CampaignImport, ACurrentOfAnAxisIsOfferedForTheTorqueAndAsksItsConstant) {
  const std::string wanted = "\ntorque_Nm = { column = \"Iq_A\", unit = \"A\", scale = \"?\" }";
  CampaignFolder folder;
  folder.write("rec.csv", rows("t_ms;angle_deg;Iq_ref_A;Id_A;Iq_A", 5));
  const auto draft = draft_campaign({folder.path() / "rec.csv"}, std::nullopt, folder.path());
  ASSERT_THAT(draft.campaign_toml, HasSubstr(wanted));
  EXPECT_THAT(said(draft), HasSubstr("a current: state its torque constant as scale"));
  const auto read = [&](const std::string& toml) {
    folder.write("campaign.toml", toml).write("nominal.toml", "[axis]\ninertia_kg_m2 = 0.1\n");
    const auto campaign = load_campaign(folder.path());
    EXPECT_THAT(campaign.findings, IsEmpty());
    return read_trial(campaign, campaign.trials.at(0));
  };
  const auto asked = read(draft.campaign_toml);
  EXPECT_FALSE(asked.usable());
  EXPECT_THAT(find(asked, FindingKind::unit_disagrees)->cure, HasSubstr("say how many N m one A is"));
  auto answered = draft.campaign_toml;
  answered.replace(answered.find("scale = \"?\""), 11, "scale = 0.5");
  EXPECT_DOUBLE_EQ(read(answered).channel("torque_Nm")[2], 1.5);
  auto without_unit = draft.campaign_toml;
  without_unit.replace(without_unit.find("unit = \"A\", scale = \"?\""), 23, "scale = \"?\"");
  EXPECT_FALSE(read(without_unit).usable());
  EXPECT_THAT(drafted(rows("t_ms;angle_deg;Iq_A;torque_Nm", 4)).campaign_toml,
              HasSubstr("# not used: column \"Iq_A\""));
}

// A stiffness per area or the trials' plates make the two numbers of an intruder unnecessary.
TEST(CampaignImport, AnIntruderIsNotAskedForWhatIsStatedOtherwise) {
  CampaignFolder folder;
  folder.write("rec.csv", rows("t_s;foot_z_m;force_N", 3));
  const auto draft = draft_campaign({folder.path() / "rec.csv"}, std::nullopt, folder.path());
  EXPECT_THAT(draft.nominal_toml, HasSubstr("not needed if each trial states plate_diameter_m"));
  EXPECT_THAT(draft.nominal_toml, HasSubstr("not needed if stiffness_per_area_N_per_m3 is stated"));
  auto nominal = draft.nominal_toml, trials = draft.campaign_toml;
  nominal.erase(nominal.find("# stiffness_per_area"), 2);
  trials.insert(trials.find("\nfile = ") + 1, "plate_diameter_m = 0.05\n");
  double believed_N_per_m = 0.0;
  const auto told = [&] {
    folder.write("campaign.toml", trials).write("nominal.toml", nominal);
    const auto campaign = load_campaign(folder.path());
    believed_N_per_m = believed_stiffness_N_per_m(campaign.trials.at(0));
    std::string all;
    for (const auto& finding : read_trial(campaign, campaign.trials.at(0)).findings)
      all += to_string(finding) + "\n";
    for (const auto& number : used_numbers(campaign).numbers) all += to_string(number) + "\n";
    return all;
  };
  const std::string asked = "terrain.stiffness_N_per_m = \"?\" in line 9: write your own number";
  EXPECT_THAT(told(), AllOf(HasSubstr(asked), Not(HasSubstr("foot.radius_m = \"?\""))));
  const auto value = nominal.find("= ", nominal.find("\nstiffness_per_area")) + 2;
  nominal.replace(value, 3, "1e6");
  EXPECT_THAT(told(), AllOf(HasSubstr("in line 9: is not needed here"), Not(HasSubstr(asked)),
                            Not(HasSubstr("terrain.stiffness_N_per_m = 1"))));
  EXPECT_NEAR(believed_N_per_m, 1e6 * 3.14159265 * 0.025 * 0.025, 1e-3);
}

TEST(CampaignImport, ATableWithoutATimeIsWrongUnlessItIsAPress) {
  EXPECT_THAT(drafted(rows("a;angle (deg)", 2)).wrong, ElementsAre(HasSubstr("no column is a time")));
  EXPECT_THAT(drafted(rows("depth (mm);force (N)", 2)).wrong, IsEmpty());
}

// The remarks of a draft are understood as soon as their # is taken away.
TEST(CampaignImport, TheDraftListsWhatMayBeAvailableAndHowToStateAShare) {
  for (const auto plant : {CampaignPlant::hopper, CampaignPlant::intruder, CampaignPlant::falling_body,
                           CampaignPlant::rotary_axis}) {
    CampaignFolder folder;
    folder.write("rec.csv", rows("t_s;a", 2));
    const auto draft = draft_campaign({folder.path() / "rec.csv"}, plant, folder.path());
    auto campaign = draft.campaign_toml, nominal = draft.nominal_toml;
    const auto available = campaign.find("[available]");
    ASSERT_NE(available, std::string::npos);
    for (auto at = campaign.find("\n# ", available); at != std::string::npos; at = campaign.find("\n# ", at))
      campaign.erase(at + 1, 2);
    for (const char* remark :
         {"_relative = 0.02   # differs by 2 %", "[known_to]", "_relative = 0.02   # known to 2 %"}) {
      const auto line = nominal.find(remark);
      ASSERT_NE(line, std::string::npos) << nominal;
      nominal.erase(nominal.rfind("# ", line), 2);
    }
    folder.write("campaign.toml", campaign).write("nominal.toml", nominal);
    const auto read = load_campaign(folder.path());
    EXPECT_THAT(read.findings, IsEmpty()) << to_string(read.findings.front());
    EXPECT_GE(read.available.size(), 2U);
    std::visit(
        [&](const auto& belief) {
          for (const auto* stated : {&belief.key_spreads, &belief.known_to}) {
            ASSERT_EQ(stated->size(), 1U) << nominal;
            EXPECT_EQ(stated->front().sd, 0.02);
          }
        },
        read.belief);
  }
}

TEST(CampaignImport, ATableOfWordsIsWrong) {
  std::string text = "t_s,force_N,who,rig,day\n";
  for (int i = 0; i < 20; ++i) text += fmt::format("{},{},ann,left,monday\n", i, 2 * i);
  EXPECT_THAT(drafted(text).wrong, ElementsAre(HasSubstr("most cells are not numbers; line 1 is taken")));
}

}  // namespace
}  // namespace sandhopper
