#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <tuple>

#include "campaign_folder.hpp"
#include "tools/campaign/trial_recording.hpp"
#include "tools/campaign/unlisted_recordings.hpp"

namespace sandhopper {
namespace {

using ::testing::HasSubstr;

constexpr auto kIntrusion = "plant = \"intruder\"\n[[trial]]\nfile = \"a.csv\"\n";

std::string refusal(const std::string& text) {
  CampaignFolder folder;
  if (!text.empty()) folder.write("campaign.toml", text);
  try {
    load_campaign(folder.path());
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(Campaign, SetUpIsKeptWithUnknownKeys) {
  CampaignFolder folder;
  folder.write("campaign.toml",
               "name = \"beads\"\nplant = \"hopper\"\n[[trial]]\nfile = \"t/1.csv\"\nkind = \"hold\"\n"
               "release_height_m = 0.05\nsession = \"b\"\nbeads = \"new\"\npayload_kg = 1\n");
  const auto campaign = load_campaign(folder.path());
  EXPECT_EQ(campaign.name, "beads");
  EXPECT_TRUE(campaign.findings.empty());
  const auto& trial = campaign.trials.at(0);
  EXPECT_EQ(trial.kind, TrialKind::hold);
  EXPECT_EQ(trial.number("release_height_m"), 0.05);
  EXPECT_EQ(trial.number("payload_kg"), 1.0);
  EXPECT_EQ(trial.text("beads"), "new");
  EXPECT_EQ(trial.number("beads"), std::nullopt);
}

TEST(Campaign, WhatCannotBeReadAtAllIsRefused) {
  EXPECT_THAT(refusal(""), HasSubstr("campaign.toml: cannot be read"));
  EXPECT_THAT(refusal("name = \"x\"\n"), HasSubstr("key 'plant' is missing"));
  EXPECT_THAT(refusal("\nplant = \"robot\"\n"),
              HasSubstr("campaign.toml:2:9: key 'plant' has no such value"));
  EXPECT_THAT(refusal("plant = \"hopper\"\n"), HasSubstr("there is no trial"));
  EXPECT_THAT(refusal("plant = \"hopper\"\nmodel = \"gone.toml\"\n[[trial]]\nfile = \"a\"\n"),
              HasSubstr("campaign.toml:2:9: the model"));
}

TEST(Campaign, AFileOfEveryTrialBesideFilesOfTheTrialsIsRefused) {
  const std::string every = "plant = \"intruder\"\n[every_trial]\nfile = \"a.csv\"\n";
  EXPECT_THAT(
      refusal(every + "[[trial]]\nfile = \"b.csv\"\n"),
      HasSubstr("campaign.toml:3:1: key 'file' of [every_trial] is a recording that no trial would use"));
  EXPECT_EQ(refusal(every + "[[trial]]\nselect = { from_s = 1.0 }\n"), "") << "one file for all trials";
}

TEST(Campaign, ARecordingThatNoTrialListsIsNoted) {
  CampaignFolder folder;
  folder.write("campaign.toml",
               std::string(kIntrusion) + "[columns]\nforce_N = { column = \"F\", unit = \"N\" }\n");
  for (const auto* name : {"a.csv", "b.csv"}) folder.write(name, "t_s,F\n0.0,1.0\n0.1,2.0\n0.2,3.0\n");
  folder.write("notes.txt", "Rig of Monday\n1 a plate of 60 mm\n2 dry sand\n")
      .write("residuals.csv", "trial,channel,t_s\na,force_N,0.1\n");
  const auto notes = unlisted_recordings(load_campaign(folder.path()));
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_THAT(to_string(notes[0]), HasSubstr("no trial lists b.csv, which lies beside the recordings"));
}

TEST(Campaign, ATrialThatCannotBeUnderstoodIsLeftOutWithItsLine) {
  CampaignFolder folder;
  folder.write("campaign.toml",
               "plant = \"hopper\"\nsampling = 1\n[[trial]]\nkind = \"hop\"\n[[trial]]\nfile = \"a.csv\"\n"
               "kind = \"jump\"\n[[trial]]\nfile = \"b.csv\"\n");
  const auto campaign = load_campaign(folder.path());
  ASSERT_EQ(campaign.trials.size(), 1U);
  EXPECT_EQ(campaign.trials[0].name, "b.csv");
  ASSERT_EQ(campaign.findings.size(), 3U);
  EXPECT_EQ(campaign.findings[0].line, 3U);
  EXPECT_THAT(campaign.findings[0].cure, HasSubstr("file ="));
  EXPECT_EQ(campaign.findings[1].line, 7U);
  EXPECT_THAT(campaign.findings[1].cure, HasSubstr("\"hop\""));
  EXPECT_EQ(campaign.findings[2].severity, FindingSeverity::note);
}

TEST(Campaign, ForeignColumnsBecomeChannels) {
  CampaignFolder folder;
  folder
      .write("campaign.toml",
             "plant = \"intruder\"\n[columns]\nt_s = { column = \"time [ms]\", scale = 0.001 }\n"
             "force_N = { column = \"Fz\", scale = -1.0, offset = 0.5 }\nfoot_z_m = \"z\"\n"
             "[[trial]]\nfile = \"a.csv\"\n[trial.columns]\nfoot_z_m = { column = \"Z_mm\", scale = 0.001, "
             "offset = 0.01 }\n")
      .write("a.csv", "time [ms],Fz,Z_mm,z,operator\n0,-1,-10,7,1\n1,-2,-11,7,1\n");
  const auto campaign = load_campaign(folder.path());
  const auto recording = read_trial(campaign, campaign.trials.at(0));
  ASSERT_TRUE(recording.usable()) << to_string(recording.findings.at(0));
  EXPECT_EQ(recording.t_s, (std::vector<double>{0.0, 0.001}));
  EXPECT_EQ(recording.channel("force_N")[1], 2.5);
  EXPECT_DOUBLE_EQ(recording.channel("foot_z_m")[1], -0.001) << "the trial's own mapping goes before";
  EXPECT_FALSE(recording.has("foot_velocity_mps"));
  EXPECT_EQ(recording.unused_columns, (std::vector<std::string>{"z", "operator"}));
  EXPECT_THROW(recording.channel("foot_velocity_mps"), std::out_of_range);
}

TEST(Campaign, RowsOfOneFileMayBeSeveralTrials) {
  CampaignFolder folder;
  std::string second_drop;
  for (int i = 0; i < 12; ++i) second_drop += fmt::format("2,{},{}\n", i, 8 - i);
  folder
      .write(
          "campaign.toml",
          "plant = \"falling_body\"\n[[trial]]\nfile = \"b.csv\"\nselect = { column = \"drop\", value = 2 }\n"
          "[[trial]]\nfile = \"c.csv\"\nselect = { from_s = 1.0, to_s = 1.5 }\n")
      .write("c.csv", "t_s,height_m\n0,5\n1,4\n2,0\n")
      .write("b.csv", "drop,t_s,height_m\n1,0,5\n1,1,4\n" + second_drop);
  const auto campaign = load_campaign(folder.path());
  const auto second = read_trial(campaign, campaign.trials.at(0));
  ASSERT_TRUE(second.usable());
  EXPECT_EQ(second.rows(), 12U);
  EXPECT_EQ(second.channel("height_m")[2], 6.0);
  EXPECT_FALSE(read_trial(campaign, campaign.trials.at(1)).usable()) << "one row is no trial";
}

// A row every 2 ms. The time is written in ms and may count from an epoch, by another column or an offset.
TrialRecording selected(const std::string& time, const std::string& select, double per_s = 1e3,
                        double start = 0.0) {
  CampaignFolder folder;
  std::string csv = "t,force_N\n";
  for (int i = 0; i < 250; ++i)
    csv += std::to_string(start + per_s * 0.002 * i) + "," + std::to_string(i) + "\n";
  folder
      .write("campaign.toml", "plant = \"intruder\"\n[columns]\nt_s = { column = \"t\", " + time +
                                  " }\n[[trial]]\nfile = \"a.csv\"\nselect = { " + select + " }\n")
      .write("a.csv", csv);
  const auto campaign = load_campaign(folder.path());
  return read_trial(campaign, campaign.trials.at(0));
}

TEST(Campaign, RowsAreSelectedBySecondsWhateverTheUnitOfTheColumn) {
  const std::string tenth = "from_s = 0.099, to_s = 0.201";
  for (const auto& [time, per_s, start] :
       {std::tuple{"unit = \"ms\"", 1e3, 0.0}, std::tuple{"scale = 1e-6", 1e6, 0.0},
        std::tuple{"unit = \"s\", scale = 1.0, offset = -1.7e9", 1.0, 1.7e9},
        std::tuple{"unit = \"s\"", 1.0, 0.0}}) {
    const auto recording = selected(time, tenth, per_s, start);
    ASSERT_EQ(recording.rows(), 51U) << time;
    EXPECT_NEAR(recording.t_s.front(), 0.1, 1e-5) << time;
    EXPECT_EQ(recording.channel("force_N").front(), 50.0) << time;
  }
  EXPECT_EQ(selected("unit = \"ms\"", "from_s = 0.0, to_s = 5.0").rows(), 250U);
}

TEST(Campaign, ASelectionThatLeavesTooFewRowsIsAnErrorWithItsNumbers) {
  const auto nine = selected("unit = \"ms\"", "from_s = 0.2, to_s = 0.217");
  EXPECT_FALSE(nine.usable());
  ASSERT_FALSE(nine.findings.empty());
  EXPECT_EQ(nine.findings[0].channel, "trial 1");
  EXPECT_THAT(nine.findings[0].what, HasSubstr("select leaves 9 of 250 rows, from 0.2 to 0.216 s"));
  EXPECT_THAT(nine.findings[0].what, HasSubstr("10 are needed"));
  const auto lines = selected("unit = \"ms\"", "from_line = 2, to_line = 4");
  EXPECT_FALSE(lines.usable());
  EXPECT_THAT(lines.findings.at(0).what, HasSubstr("select leaves 3 rows, from 0 to 0.004 s"));
  const auto none = selected("unit = \"ms\"", "from_s = 5.0");
  EXPECT_FALSE(none.usable());
  EXPECT_THAT(none.findings.at(0).what, HasSubstr("select leaves none of 250 rows"));
  EXPECT_THAT(none.findings.at(0).what, HasSubstr("from 0 to 0.498 s"));
  const auto ten = selected("unit = \"ms\"", "from_s = 0.2, to_s = 0.219");
  EXPECT_TRUE(ten.usable());
  ASSERT_EQ(ten.rows(), 10U);
  for (const auto& finding : ten.findings) EXPECT_THAT(finding.what, ::testing::Not(HasSubstr("select")));
}

TEST(Campaign, AFolderMayStandForTheOneRecordingInIt) {
  CampaignFolder folder;
  folder.write("campaign.toml", kIntrusion).write("a.csv/hop.csv", "t_s,force_N\n0,1\n1,2\n");
  const auto campaign = load_campaign(folder.path());
  EXPECT_TRUE(read_trial(campaign, campaign.trials.at(0)).usable());
  folder.write("a.csv/hop2.csv", "t_s,force_N\n0,1\n");
  const auto two = read_trial(campaign, campaign.trials.at(0));
  ASSERT_FALSE(two.usable());
  EXPECT_THAT(two.findings.at(0).what, HasSubstr("holds 2 recordings"));
}

TEST(Campaign, RowsOfOneInstantBecomeOne) {
  CampaignFolder folder;
  folder.write("campaign.toml", kIntrusion).write("a.csv", "t_s,force_N,foot_z_m\n0,1,\n0,,2\n1,3,4\n");
  const auto campaign = load_campaign(folder.path());
  const auto recording = read_trial(campaign, campaign.trials.at(0));
  EXPECT_EQ(recording.t_s, (std::vector<double>{0, 1}));
  EXPECT_EQ(recording.channel("foot_z_m")[0], 2.0);
  EXPECT_EQ(recording.findings.at(0).kind, FindingKind::time_stands_still);
}

}  // namespace
}  // namespace sandhopper
