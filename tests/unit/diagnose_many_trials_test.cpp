#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "tests/unit/diagnose_campaigns.hpp"
#include "tools/diagnose/discrepancy/left_over.hpp"
#include "tools/diagnose/recordings/many_trials.hpp"

namespace sandhopper::diagnose {
namespace {

double nothing(double, double, double) { return 0.0; }

std::set<std::string> names(const Recordings& recordings) {
  std::set<std::string> names;
  for (const auto& trial : recordings.trials) names.insert(trial.name);
  return names;
}

TEST(DiagnoseManyTrials, AreSpreadOverTheSetUpsInWhateverOrderTheyCome) {
  auto recordings = drops(nothing, 1, 32);  // eight from each of four heights
  const auto some = spread_over(recordings, 8);
  ASSERT_EQ(some.trials.size(), 8u);
  ASSERT_EQ(some.beliefs.size(), 8u);
  std::map<double, int> of_height;
  for (const auto& trial : some.trials) ++of_height[trial.setup.at("release_height_m")];
  EXPECT_EQ(of_height.size(), 4u);
  for (const auto& [height_m, count] : of_height) EXPECT_EQ(count, 2) << height_m;
  std::ranges::reverse(recordings.trials);
  std::ranges::rotate(recordings.trials, recordings.trials.begin() + 7);
  EXPECT_EQ(names(spread_over(recordings, 8)), names(some));
  EXPECT_EQ(names(spread_over(recordings, 100)), names(recordings));
}

TEST(DiagnoseManyTrials, BeginWhereSomeOfThemEnded) {
  const auto recordings = drops(nothing, 1, 12);
  const Problem all = prepare(recordings).problem;
  const Problem some = prepare(spread_over(recordings, 5)).problem;
  Point found = null_point(some);
  found.hypothesis.candidates = {0, 1};
  for (const std::size_t c : {0u, 1u}) {
    std::vector<double> values;
    for (const auto& parameter : some.candidates[c].parameters) values.push_back(parameter.typical);
    found.hypothesis.values.push_back(values);
  }
  const auto carried = carried_over(some, {found}, all, null_point(all));
  ASSERT_EQ(carried.size(), 1u);
  EXPECT_EQ(carried.front().nuisances.size(), 12u);
  for (std::size_t e = 0; e < 2; ++e)
    EXPECT_EQ(all.candidates[carried.front().hypothesis.candidates[e]].label(), some.candidates[e].label());
}

// An offset of half a standard deviation in every trial must not count more with forty trials than with
// twelve.
TEST(DiagnoseManyTrials, LeanAsTwelveOfThemDo) {
  for (const std::size_t trials : {12u, 40u}) {
    const Problem problem = prepare(drops(nothing, 1, trials)).problem;
    Point point = null_point(problem);
    ASSERT_FALSE(problem.trials.front()->trial_nuisances.empty());
    for (std::size_t t = 0; t < trials; ++t)
      point.nuisances[t][0] = 0.5 * problem.trials[t]->trial_nuisances[0].sd;
    EXPECT_NEAR(largest_common_shift(problem, point).z, 0.5 * std::sqrt(12.0), 1e-9) << trials;
  }
}

}  // namespace
}  // namespace sandhopper::diagnose
