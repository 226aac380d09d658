#include "drivers/can/departure_ledger.hpp"

#include <gtest/gtest.h>

namespace sandhopper {
namespace {

constexpr std::int64_t kMs = 1'000'000;

TEST(DepartureLedger, FramesThatLeaveHoldNothingUp) {
  DepartureLedger ledger;
  for (std::int64_t k = 0; k < 100; ++k) {
    EXPECT_FALSE(ledger.holds(k * kMs));
    ledger.sent(1, k * kMs);
    ledger.sent(2, k * kMs + 20'000);
    ledger.departed(1);
    ledger.departed(2);
  }
  EXPECT_EQ(ledger.waiting(), 0U);
}

TEST(DepartureLedger, ALateEchoWithinACycleAndAHalfIsNoHold) {
  DepartureLedger ledger;
  ledger.sent(1, 0);
  EXPECT_FALSE(ledger.holds(1 * kMs + 400'000)) << "this process was late, or the adapter is slow";
  EXPECT_TRUE(ledger.holds(2 * kMs));
  ledger.departed(1);
  EXPECT_FALSE(ledger.holds(3 * kMs));
}

TEST(DepartureLedger, AFrameThatAOneShotControllerDroppedIsSettledByTheNextEcho) {
  DepartureLedger ledger;
  ledger.sent(1, 0);
  ledger.sent(2, 0);
  ledger.departed(1);
  ledger.sent(1, kMs);
  ledger.departed(1);
  EXPECT_FALSE(ledger.holds(2 * kMs)) << "number 2 will not come any more";
  EXPECT_EQ(ledger.waiting(), 0U);
}

TEST(DepartureLedger, OnABlockedBusOneCyclesFramesAreHeldUntilOnlyOffIsSent) {
  DepartureLedger ledger;
  ledger.sent(1, 0);
  ledger.sent(2, 0);
  int taken = 0;
  for (std::int64_t k = 2; k <= 10; ++k) taken += !ledger.holds(k * kMs);
  EXPECT_EQ(taken, 0);
  EXPECT_FALSE(ledger.holds(11 * kMs)) << "the frames that take the torque away queue up behind";
  ledger.sent(1, 11 * kMs);
  EXPECT_TRUE(ledger.holds(13 * kMs)) << "and they, too, one cycle's at a time";
}

TEST(DepartureLedger, EchoesOfOthersAndTooManyFramesAreNothing) {
  DepartureLedger ledger;
  ledger.departed(1);
  for (int i = 0; i < 40; ++i) ledger.sent(1, 0);
  EXPECT_EQ(ledger.waiting(), 16U);
  ledger.departed(7);
  EXPECT_EQ(ledger.waiting(), 16U);
  EXPECT_FALSE(ledger.holds(100 * kMs));
  EXPECT_EQ(ledger.waiting(), 0U);
}

TEST(DepartureLedger, IsSettledOnlyOnceALaterFrameHasLeft) {
  DepartureLedger ledger;
  EXPECT_TRUE(ledger.settled());
  ledger.sent(1, 0);
  EXPECT_FALSE(ledger.settled());
  EXPECT_FALSE(ledger.holds(100 * kMs)) << "its echo is not waited for any more";
  EXPECT_FALSE(ledger.settled()) << "but it may still leave";
  ledger.sent(1, 100 * kMs);
  ledger.departed(1);
  EXPECT_TRUE(ledger.settled());
}

}  // namespace
}  // namespace sandhopper
