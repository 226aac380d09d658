#include "firmware/supervision/cycle_check.hpp"

#include <gtest/gtest.h>

namespace sandhopper {
namespace {

const DetectorMask kAll;

// A cycle at 1 kHz that misses cycles if told to.
class Cycles {
 public:
  FaultFound next(std::uint64_t missed = 0) {
    frame_.cycle += 1 + missed;
    frame_.overruns += static_cast<std::uint32_t>(missed);
    frame_.time_ns = static_cast<std::int64_t>(frame_.cycle) * 1'000'000;
    Findings findings(kAll);
    check_.see(frame_, findings);
    frame_.watchdog_stall_ns = 0;
    return findings.worst();
  }
  SensorFrame& frame() { return frame_; }

 private:
  SupervisionConfig config_;
  CycleCheck check_{config_};
  SensorFrame frame_{};
};

TEST(CycleCheck, AsManyMissedGridPointsAsAllowedAreNoGap) {
  Cycles cycles;
  cycles.next();
  EXPECT_EQ(cycles.next(20).fault, Fault::none);
  const auto found = cycles.next(21);
  EXPECT_EQ(found.fault, Fault::cycle_gap);
  EXPECT_EQ(found.values[0], 21.0);
  EXPECT_EQ(cycles.next().fault, Fault::none);
}

TEST(CycleCheck, TheFirstCycleHasNoneBeforeIt) {
  Cycles cycles;
  EXPECT_EQ(cycles.next(500).fault, Fault::none);
}

// Every third cycle is missed: 51 of 153.
TEST(CycleCheck, OverrunsAreCountedWithinASecond) {
  Cycles cycles;
  cycles.next();
  int until = 0;
  while (until < 200 && cycles.next(1).fault == Fault::none) {
    cycles.next();
    ++until;
  }
  EXPECT_EQ(until, 50);
}

TEST(CycleCheck, FiftyOverrunsASecondGoOnForEver) {
  Cycles cycles;
  cycles.next();
  for (int i = 0; i < 10'000; ++i)
    ASSERT_EQ(cycles.next(i % 19 == 0 ? 1 : 0).fault, Fault::none) << "50 a second, after " << i;
}

TEST(CycleCheck, TheWatchdogsTripIsNamedWithItsSeconds) {
  Cycles cycles;
  cycles.next();
  cycles.frame().watchdog_stall_ns = 25'000'000;
  const auto found = cycles.next(24);
  EXPECT_EQ(found.fault, Fault::watchdog_tripped) << "limp is harsher than the gap's damp";
  EXPECT_DOUBLE_EQ(found.values[0], 0.025);
}

}  // namespace
}  // namespace sandhopper
