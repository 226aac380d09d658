#pragma once
#include <cstdint>

#include "firmware/sensor_frame.hpp"
#include "firmware/supervision/findings.hpp"
#include "firmware/supervision/supervision_config.hpp"

namespace sandhopper {

// Checks the cycle's timing: grid points missed in a row, overruns within a second, and the watchdog.
class CycleCheck {
 public:
  explicit CycleCheck(const SupervisionConfig& config) noexcept : config_(config) {}

  void see(const SensorFrame& frame, Findings& findings) noexcept {
    const auto gap = started_ ? static_cast<std::int64_t>(frame.cycle - last_cycle_) - 1 : 0;
    if (!started_ || frame.time_ns - second_began_ns_ >= kSecond_ns) {
      second_began_ns_ = frame.time_ns;
      overruns_at_begin_ = frame.overruns;
    }
    const auto overruns = static_cast<double>(frame.overruns - overruns_at_begin_);
    findings.add_if(gap > config_.cycle_gap, Fault::cycle_gap, static_cast<double>(gap), config_.cycle_gap);
    findings.add_if(overruns > config_.overruns_per_s, Fault::cycle_overruns, overruns,
                    config_.overruns_per_s);
    findings.add_if(frame.watchdog_stall_ns != 0, Fault::watchdog_tripped,
                    1e-9 * static_cast<double>(frame.watchdog_stall_ns), 0.0);
    last_cycle_ = frame.cycle;
    started_ = true;
  }

 private:
  static constexpr std::int64_t kSecond_ns = 1'000'000'000;
  const SupervisionConfig& config_;
  bool started_ = false;
  std::uint64_t last_cycle_ = 0;
  std::int64_t second_began_ns_ = 0;
  std::uint32_t overruns_at_begin_ = 0;
};

}  // namespace sandhopper
