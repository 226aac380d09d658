#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "campaign_folder.hpp"
#include "tools/campaign/campaign_draft.hpp"

// Drafts of `hop campaign import`, and its words for a file that it cannot read by itself.
namespace sandhopper {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

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
