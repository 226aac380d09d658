#pragma once
#include <cstdint>

#include "firmware/log/log_recovery.hpp"

namespace sandhopper {

// Counts missing frames of a log by their cycle numbers. A number that does not increase (damaged log) is
// skipped.
class CycleCount {
 public:
  void see(const SensorFrame& frame, LogRecovery& result) {
    if (!result.cycles) {
      result.cycles.emplace();
      result.cycles->first = frame.cycle;
      result.cycles->first_ns = frame.time_ns;
    } else if (frame.cycle > result.cycles->last) {
      const std::uint64_t jump = frame.cycle - result.cycles->last - 1;
      const std::uint64_t overruns = frame.overruns - overruns_;
      const std::uint64_t skipped = jump < overruns ? jump : overruns;
      result.cycles->skipped += skipped;
      result.cycles->missing_inside += jump - skipped;
    } else {
      return;
    }
    result.cycles->last = frame.cycle;
    result.cycles->last_ns = frame.time_ns;
    overruns_ = frame.overruns;
  }
  // Number of cycles that ran between the last frame seen, with number `last_cycle`, and this later one.
  std::uint64_t missing_until(const SensorFrame& later, std::uint64_t last_cycle) const {
    const std::uint64_t jump = later.cycle - last_cycle - 1;
    const std::uint64_t overruns = later.overruns - overruns_;
    return jump > overruns ? jump - overruns : 0;
  }

 private:
  std::uint32_t overruns_ = 0;
};

}  // namespace sandhopper
