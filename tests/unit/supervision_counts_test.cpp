#include <gtest/gtest.h>

#include "firmware/supervision/counts.hpp"

namespace sandhopper {
namespace {

// Count after `samples` samples of which every `period`-th is bad.
double after(double leak, int period, int samples) {
  LeakyCount count{leak};
  for (int i = 1; i <= samples; ++i) count.see(i % period == 0);
  return count.value();
}

TEST(LeakyCount, AShareAboveLeakOverOnePlusLeakGrowsWithoutEnd) {
  // Leak 0.25: up to one bad sample of five is tolerated. With one of four the count grows by 1 - 3 / 4 each
  // time; with one of six it falls to zero in between.
  EXPECT_DOUBLE_EQ(after(0.25, 4, 400), 25.75);
  EXPECT_DOUBLE_EQ(after(0.25, 5, 500), 1.0);
  EXPECT_DOUBLE_EQ(after(0.25, 6, 600), 1.0);
}

TEST(LeakyCount, ForgetsButNeverBelowZero) {
  LeakyCount count{0.5};
  count.see(true);
  EXPECT_EQ(count.value(), 1.0);
  EXPECT_EQ(count.see(false), 0.5);
  for (int i = 0; i < 10; ++i) count.see(false);
  EXPECT_EQ(count.value(), 0.0);
  EXPECT_EQ(count.see(true), 1.0) << "no credit for good ones";
}

TEST(LeakyCount, WithoutALeakCountsAll) { EXPECT_DOUBLE_EQ(after(0.0, 10, 1000), 100.0); }

TEST(LeakyCount, ResetForgetsAll) {
  LeakyCount count{0.25};
  count.see(true);
  count.reset();
  EXPECT_EQ(count.value(), 0.0);
}

TEST(RecentShare, BeforeTheFirstAllAreTakenToHaveHadIt) {
  RecentShare<50> share;
  EXPECT_EQ(share.share(), 1.0);
  for (int i = 0; i < 10; ++i) share.see(false);
  EXPECT_DOUBLE_EQ(share.share(), 0.8);
}

TEST(RecentShare, SeesTheLastOnesOnly) {
  RecentShare<50> share;
  for (int i = 0; i < 50; ++i) share.see(false);
  EXPECT_EQ(share.share(), 0.0);
  for (int i = 0; i < 25; ++i) share.see(true);
  EXPECT_DOUBLE_EQ(share.share(), 0.5);
  for (int i = 0; i < 25; ++i) share.see(i % 5 == 0);
  EXPECT_DOUBLE_EQ(share.share(), 0.6);
  share.reset();
  EXPECT_EQ(share.share(), 1.0);
}

}  // namespace
}  // namespace sandhopper
