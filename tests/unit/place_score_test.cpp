#include "tools/experiment/place_score.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "tools/experiment/bed_score.hpp"

namespace sandhopper {
namespace {

const BedCase& bed_named(const std::string& name) {
  return *std::ranges::find(bed_cases(), name, &BedCase::name);
}

TEST(PlaceScore, OnlyBedsOfOneFormHaveACommonCurve) {
  for (const auto* name : {"line", "gradually_denser", "power_1.4"})
    EXPECT_TRUE(has_common_curve(bed_named(name))) << name;
  for (const auto* name : {"power_law", "stiff_over_soft", "crust"})
    EXPECT_FALSE(has_common_curve(bed_named(name))) << name;
}

TEST(PlaceScore, FirstStridesAreJoinedInTheirOrder) {
  constexpr long kTrials = 22;
  const auto scores = score_beds({.beds = {"line", "crust"}, .trials = kTrials, .places = {1, 5}});
  ASSERT_EQ(scores.size(), 2U);
  ASSERT_EQ(scores[0].places.size(), 2U);
  const auto &one = scores[0].places[0], &five = scores[0].places[1];
  EXPECT_EQ(one.sessions, scores[0].first.strides);
  EXPECT_EQ(one.band.covered, scores[0].first.band.covered);  // one place is a first stride
  EXPECT_EQ(one.band.depths, scores[0].first.band.depths);
  EXPECT_EQ(five.sessions, 4.0);
  EXPECT_GT(five.band.share(), 0.8);
  EXPECT_TRUE(scores[1].places.empty());
}

TEST(PlaceScore, TooFewStridesAreNoSession) {
  const auto scores = score_beds({.beds = {"line"}, .trials = 1, .places = {2}});
  EXPECT_EQ(scores[0].places[0].sessions, 0.0);
}

}  // namespace
}  // namespace sandhopper
