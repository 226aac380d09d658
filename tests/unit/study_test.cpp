#include "tools/report/study.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <tuple>

namespace sandhopper {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(StudyPage, CarriesEveryItemAndAsksForNothing) {
  Study study{.title = "Beads & <plates>"};
  study.sections.push_back(
      {.title = "Depth",
       .items = {std::string("</script><script>alert(1)</script>"),
                 StudyTable{.title = "k", .columns = {"trial", "k, N/m"}, .rows = {{"001", "1500"}}},
                 StudyFigure{.title = "Force",
                             .x_label = "depth, mm",
                             .y_label = "force, N",
                             .series = {{.label = "measured", .x = {0.0, 1.0}, .y = {NAN, 2.5}}}}}});
  const std::string page = study_page(study);
  EXPECT_THAT(page, HasSubstr("<title>Beads &amp; &lt;plates></title>"));
  EXPECT_THAT(page, HasSubstr("\"y\":[null,2.5]"));
  EXPECT_THAT(page, HasSubstr("\"kind\":\"table\""));
  EXPECT_THAT(page, Not(HasSubstr("<script>alert(1)")));
  EXPECT_THAT(page, Not(HasSubstr("https://")));
  EXPECT_THAT(page, Not(HasSubstr("{{")));
}

TEST(StudyPage, ShowsItsTextAndTablesWithoutScripts) {
  Study study{
      .title = "Beads", .verdict = "One effect is missing.", .warnings = {"Two trials were left out."}};
  study.answers.push_back({.heading = "Where",
                           .lines = {{StudyAnswer::Style::lead, "the bed"}},
                           .bars = {{.label = "with", .share = 0.5, .text = "1.2 times the noise"}}});
  study.sections.push_back(
      {.title = "Depth",
       .items = {std::string("</noscript><b>"),
                 StudyTable{.columns = {"trial", "k, N/m"}, .rows = {{"001", "1500"}}, .note = "of 9 trials"},
                 StudyFigure{.title = "Force", .x_label = "depth, mm", .y_label = "force, N"}}});
  const std::string page = study_page(study);
  const auto begin = page.find("<noscript>\n"), end = page.find("</noscript>", begin);
  ASSERT_NE(begin, std::string::npos);
  const auto text = page.substr(begin, end - begin);
  for (const auto* part :
       {"One effect is missing.", "Two trials were left out.", "<h3>Where</h3>", "<p>the bed</p>",
        "<p>with: 1.2 times the noise</p>", "<th>k, N/m</th>", "<td>1500</td>", "of 9 trials",
        "&lt;/noscript>&lt;b>", "Figure: Force (force, N over depth, mm). It needs JavaScript."})
    EXPECT_THAT(text, HasSubstr(part));
}

TEST(StudyPage, FifteenTrialsLookDifferentByMoreThanAShade) {
  std::set<std::tuple<std::string, bool, bool>> lines;
  for (std::size_t i = 0; i < 15; ++i) {
    StudySeries series;
    tell_apart(series, i);
    EXPECT_EQ(series.shade, 0.0);
    lines.emplace(series.color, series.dashed, series.dotted);
  }
  EXPECT_EQ(lines.size(), 15u);
}

TEST(StudyPage, ThousandsOfPointsAreThinnedAndItSaysSo) {
  StudySeries series{.label = "trials"};
  for (int i = 0; i < 4000; ++i) {
    series.x.push_back(i);
    series.y.push_back(2 * i);
  }
  Study study{.title = "many"};
  study.sections.push_back({.title = "S", .items = {StudyFigure{.series = {series}}}});
  const std::string page = study_page(study);
  EXPECT_THAT(page, HasSubstr("trials (one of 3 points)"));
  EXPECT_THAT(page, HasSubstr("\"x\":[0.0,3.0,6.0,"));
  EXPECT_THAT(page, HasSubstr(",3999.0]"));
  EXPECT_THAT(page, HasSubstr("\"y\":[0.0,6.0,12.0,"));
}

}  // namespace
}  // namespace sandhopper
