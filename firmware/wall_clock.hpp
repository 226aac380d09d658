#pragma once
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <utility>

#include "drivers/clock.hpp"

namespace sandhopper {

// Detects a jump of CLOCK_REALTIME: somebody set the date, or the computer slept. The cycle does not depend
// on it. It is logged so that dates in other programs' files can be compared with the log's.
class WallClock {
 public:
  // CLOCK_REALTIME minus CLOCK_MONOTONIC [ns].
  explicit WallClock(std::function<std::int64_t()> offset_ns = realtime_offset_ns)
      : read_(std::move(offset_ns)), last_ns_(read_()) {}

  // Jump since the last call [ns], 0 for none. NTP's slewing (at most 0.5 ms/s) does not count.
  std::int64_t step_ns() noexcept {
    const auto now_ns = read_();
    const auto step_ns = now_ns - last_ns_;
    last_ns_ = now_ns;
    return std::abs(step_ns) < kSmallest_ns ? 0 : step_ns;
  }

 private:
  static constexpr std::int64_t kSmallest_ns = 10'000'000;
  std::function<std::int64_t()> read_;
  std::int64_t last_ns_;
};

}  // namespace sandhopper
