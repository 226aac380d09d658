#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tools/campaign/available.hpp"
#include "tools/diagnose/model/reach.hpp"

namespace sandhopper {
namespace {

using diagnose::Reach;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

Available read(const char* text, std::vector<Finding>* findings = nullptr) {
  std::vector<Finding> unused;
  return read_available(parse_config_text("campaign.toml", text).root, "campaign.toml",
                        findings != nullptr ? *findings : unused);
}

std::vector<diagnose::Trial> recorded() {
  std::vector<diagnose::Trial> trials(2);
  trials[0].setup = {{"release_height_m", 0.05}, {"plate_diameter_m", 0.06}};
  trials[1].setup = {{"release_height_m", 0.20}, {"plate_diameter_m", 0.08}};
  return trials;
}

TEST(CampaignAvailable, ListsRangesAndWordsAreRead) {
  const auto available = read(
      "plate_diameter_m = [0.08, 0.06]\n"
      "release_height_m = { from = 0.05, to = 1 }\n"
      "profile = [\"through\"]\n");
  EXPECT_THAT(available.at("plate_diameter_m").values, ElementsAre(0.06, 0.08));
  EXPECT_TRUE(available.at("release_height_m").is_range);
  EXPECT_THAT(available.at("release_height_m").values, ElementsAre(0.05, 1.0));
  EXPECT_THAT(available.at("profile").words, ElementsAre("through"));
}

TEST(CampaignAvailable, WhatCannotBeUnderstoodIsSaidWithItsLineAndLeftOut) {
  for (const char* text : {"x_m = 1.0", "x_m = []", "x_m = [1.0, \"one\"]", "x_m = { from = 2, to = 1 }",
                           "x_m = { from = 1 }", "x_m = \"all\"", "x_m = [nan]"}) {
    std::vector<Finding> findings;
    EXPECT_THAT(read(text, &findings), IsEmpty()) << text;
    ASSERT_EQ(findings.size(), 1u) << text;
    EXPECT_EQ(findings[0].channel, "available.x_m");
    EXPECT_EQ(findings[0].line, 1u);
    EXPECT_THAT(findings[0].cure, HasSubstr("x_m = { from = 1.0, to = 2.0 }"));
  }
}

TEST(Reach, IsWhatWasRecordedUnlessTheCampaignListsMore) {
  const Reach reach(recorded(), read("impact_speed_mps = [0.1, 0.4]\nprofile = [\"cycles\"]"),
                    {{"profile", {"through"}}});
  EXPECT_THAT(reach.settings("release_height_m", {0.01, 0.1, 0.5}), ElementsAre(0.05, 0.1, 0.20));
  EXPECT_THAT(reach.settings("impact_speed_mps", {0.02, 0.3}), ElementsAre(0.1, 0.4));
  EXPECT_THAT(reach.settings("payload_kg", {1.0}), IsEmpty());
  EXPECT_THAT(reach.parts("plate_diameter_m", {0.07}), ElementsAre(0.06, 0.08))
      << "there is no plate between";
  EXPECT_TRUE(reach.allows("profile", "through"));
  EXPECT_TRUE(reach.allows("profile", "cycles"));
  EXPECT_FALSE(reach.allows("profile", "stop_and_withdraw"));
  EXPECT_TRUE(reach.allows("other", "anything"));
}

TEST(Reach, OfFreeNumbersHoldsWhatTheCampaignDoesNotLimitButNoParts) {
  const Reach own(recorded(), read("impact_speed_mps = { from = 0.1, to = 0.4 }\nprofile = [\"cycles\"]"),
                  {{"mode", {"slow"}}});
  const Reach reach = own.with_free_numbers();
  EXPECT_THAT(reach.settings("release_height_m", {0.01, 0.1, 0.5}), ElementsAre(0.01, 0.1, 0.5));
  EXPECT_THAT(reach.settings("impact_speed_mps", {0.02, 0.3, 1.0}), ElementsAre(0.1, 0.3, 0.4));
  EXPECT_FALSE(reach.allows("impact_speed_mps", 0.5));
  EXPECT_TRUE(reach.allows("release_height_m", 0.5));
  EXPECT_THAT(reach.parts("plate_diameter_m", {0.07}), ElementsAre(0.06, 0.08));
  EXPECT_THAT(reach.parts("payload_kg", {1.0}), IsEmpty());
  EXPECT_TRUE(reach.allows("mode", "fast"));
  EXPECT_FALSE(reach.allows("profile", "through"));
  EXPECT_THAT(own.with_any_part().parts("payload_kg", {1.0}), ElementsAre(1.0));
  EXPECT_THAT(own.with_any_part().settings("impact_speed_mps", {0.02, 0.3}), ElementsAre(0.1, 0.3, 0.4));
}

TEST(Reach, TellsTheRecordedRangesThatASetUpLeaves) {
  const Reach reach(recorded(), read("impact_speed_mps = [0.1, 0.4]"), {});
  EXPECT_EQ(reach.ranges_left_by({{"release_height_m", 0.1}}), "");
  EXPECT_EQ(reach.ranges_left_by({{"release_height_m", 0.20000000001}, {"impact_speed_mps", 0.4}}), "");
  EXPECT_EQ(reach.ranges_left_by({{"release_height_m", 1.9}, {"payload_kg", 1.0}}),
            "release height 0.05 to 0.2 m");
}

}  // namespace
}  // namespace sandhopper
