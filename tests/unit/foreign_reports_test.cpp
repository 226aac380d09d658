#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <regex>

#include "campaign_folder.hpp"
#include "foreign_conditions.hpp"
#include "tools/campaign/campaign_draft.hpp"

// Each condition takes the way of its user: `hop campaign import`, then the campaign that it wrote. Either
// the numbers are right, or nothing is computed. The messages are listed in the documentation.
namespace sandhopper {
namespace {

using ::testing::HasSubstr;

std::vector<ForeignCondition> all_conditions() {
  auto all = conditions_of_times();
  for (const auto& more :
       {conditions_of_cells(), conditions_of_tables(), conditions_of_units(), conditions_of_samples(),
        conditions_of_sampling(), conditions_of_clocks(), conditions_of_texts(), conditions_of_forms()})
    all.insert(all.end(), more.begin(), more.end());
  return all;
}

struct Imported {
  std::string told;  // refusal, recognised format, findings
  std::optional<TrialRecording> recording;
};

Imported imported_condition(const ForeignCondition& condition) {
  CampaignFolder folder;
  folder.write("rec.csv", condition.text);
  Imported out;
  try {
    const auto draft =
        draft_campaign({folder.path() / "rec.csv"}, condition.plant, folder.path(), condition.names);
    // The user replaces each "?" of the draft by a number.
    const auto nominal = std::regex_replace(draft.nominal_toml, std::regex("\"\\?\""), "1.0");
    folder.write("campaign.toml", draft.campaign_toml).write("nominal.toml", nominal);
    for (const auto& line : draft.said) out.told += line + "\n";
  } catch (const std::runtime_error& error) {
    out.told = error.what();
    return out;
  }
  const auto campaign = load_campaign(folder.path());
  out.recording = read_trial(campaign, campaign.trials.at(0));
  for (const auto& finding : out.recording->findings) out.told += to_string(finding) + "\n";
  return out;
}

// The row that is 1 s (axis: 0.1 s) after the first.
std::size_t row_after(const TrialRecording& recording, double step_s) {
  std::size_t row = 0;
  while (row + 1 < recording.rows() && recording.t_s[row] < recording.t_s[0] + step_s - 1e-4) ++row;
  return row;
}

void expect_right(const ForeignCondition& condition, const TrialRecording& recording,
                  const std::string& told) {
  ASSERT_TRUE(recording.usable()) << told;
  EXPECT_GE(recording.rows(), 70U) << told;
  if (condition.plant == CampaignPlant::intruder) {
    const auto row = row_after(recording, 1.0);
    EXPECT_NEAR(recording.t_s[row] - recording.t_s[0], 1.0, 2e-3) << told;
    EXPECT_NEAR(recording.channel("foot_z_m")[row], -4e-3, 1e-6) << told;
    const double thousands = condition.id.starts_with("no-break") ? 1000.0 : 0.0;
    EXPECT_NEAR(recording.channel("force_N")[row], thousands + plate_row(10).force_N, 2e-3) << told;
  } else if (condition.plant == CampaignPlant::falling_body) {
    EXPECT_NEAR(recording.channel("accel_mps2")[20], 9.81, 0.02) << told;
  } else if (condition.id == "an angle within one turn") {
    EXPECT_NEAR(recording.channel("position_rad")[79], 1440 * 0.79 / 57.29578, 1e-3) << told;
  } else {
    const auto row = row_after(recording, 0.1);
    EXPECT_NEAR(recording.t_s[row] - recording.t_s[0], 0.1, 1e-5) << told;
    EXPECT_NEAR(recording.channel("position_rad")[row], axis_row(10).angle_rad, 1e-5) << told;
    EXPECT_NEAR(recording.channel("torque_Nm")[row], axis_row(10).torque_Nm, 1e-5) << told;
  }
}

TEST(ForeignReports, AConditionIsReadRightOrNothingIsComputedFromIt) {
  for (const auto& condition : all_conditions()) {
    SCOPED_TRACE(condition.id);
    const auto got = imported_condition(condition);
    if (condition.is_usable) {
      ASSERT_TRUE(got.recording) << got.told;
      if (condition.is_as_written) {
        EXPECT_TRUE(got.recording->usable()) << got.told;
        continue;
      }
      expect_right(condition, *got.recording, got.told);
      continue;
    }
    EXPECT_FALSE(got.told.empty());
    const bool lost = got.recording && got.recording->usable() &&
                      !(got.recording->has("force_N") && got.recording->has("foot_z_m"));
    EXPECT_TRUE(!got.recording || !got.recording->usable() || lost) << got.told;
  }
}

// Reads rows of the form "| condition | `message of hop` |".
std::map<std::string, std::vector<std::string>> rows_of_the_page() {
  std::ifstream in(std::string(SANDHOPPER_SOURCE_DIR) + "/tools/docs/guide/foreign_conditions.md");
  std::map<std::string, std::vector<std::string>> rows;
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with("| ")) continue;
    const auto bar = line.find(" | ", 2);
    auto& words = rows[line.substr(2, bar - 2)];
    for (auto at = line.find('`', bar); at != std::string::npos;) {
      const auto end = line.find('`', at + 1);
      words.push_back(line.substr(at + 1, end - at - 1));
      at = line.find('`', end + 1);
    }
  }
  return rows;
}

TEST(ForeignReports, ThePageSaysWhatIsSaid) {
  const auto rows = rows_of_the_page();
  for (const auto& condition : all_conditions()) {
    SCOPED_TRACE(condition.id);
    ASSERT_TRUE(rows.contains(condition.id)) << "no row of the page";
    const auto told = imported_condition(condition).told;
    for (const auto& words : rows.at(condition.id)) EXPECT_THAT(told, HasSubstr(words));
    EXPECT_TRUE((condition.is_usable && !condition.is_as_written) || !rows.at(condition.id).empty())
        << "what is said?\n"
        << told;
  }
}

TEST(ForeignReports, EveryRowOfThePageHasItsTable) {
  const auto all = all_conditions();
  std::size_t tested = 0;
  for (const auto& [id, words] : rows_of_the_page()) {
    const bool is_head = id == "condition";
    tested += !is_head;
    EXPECT_TRUE(is_head || std::ranges::find(all, id, &ForeignCondition::id) != all.end()) << id;
  }
  EXPECT_EQ(tested, all.size());
}

}  // namespace
}  // namespace sandhopper
