#include <gtest/gtest.h>

#include <algorithm>

#include "tests/unit/diagnose_campaigns.hpp"

// The part `where` of an answer: the channels and phases in which the finding shows.
namespace sandhopper::diagnose {
namespace {

bool is_named(const Diagnosis& d, const std::string& channel, const std::string& phase) {
  return std::ranges::any_of(d.where,
                             [&](const Where& w) { return w.channel == channel && w.phase == phase; });
}

// A body that falls from rest is slow at first: a drag shows late, and there in both sensors.
TEST(DiagnoseWhere, ADragShowsWhereABodyIsFast) {
  const auto d = diagnose(drops([](double, double, double v) { return -0.003 * std::abs(v) * v; }));
  ASSERT_EQ(d.verdict, Verdict::missing_physics);
  EXPECT_TRUE(is_named(d, "accel_mps2", "late"));
  EXPECT_TRUE(is_named(d, "height_m", "late"));
  EXPECT_FALSE(is_named(d, "height_m", "early"));
  EXPECT_EQ(d.where.front().phase_in_words(), "the last third");
  double shares = 0.0;
  for (const auto& w : d.where) {
    EXPECT_EQ(w.port, "body");
    EXPECT_FALSE(w.unexplained);
    shares += w.share_of_excess;
  }
  EXPECT_GT(shares, 0.9);
  EXPECT_LE(shares, 1.0 + 1e-9);
}

// A scale of the height sensor changes no other channel, although a fit without it bends the others, too.
TEST(DiagnoseWhere, AFaultOfASensorShowsInThatSensorAlone) {
  const auto d = diagnose(drops([](double, double, double) { return 0.0; }, 1, 8, 0.97));
  ASSERT_EQ(d.verdict, Verdict::missing_physics);
  ASSERT_FALSE(d.where.empty());
  for (const auto& w : d.where) EXPECT_EQ(w.channel, "height_m");
}

TEST(DiagnoseWhere, NothingMissingShowsNowhere) {
  EXPECT_TRUE(diagnose(drops([](double, double, double) { return 0.0; })).where.empty());
}

}  // namespace
}  // namespace sandhopper::diagnose
