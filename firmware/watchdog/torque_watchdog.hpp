#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <thread>

#include "firmware/watchdog/heartbeat.hpp"
#include "firmware/watchdog/watchdog_config.hpp"

namespace sandhopper {

// A thread with a priority above the cycle's. It takes the torque away when the cycle stands still for longer
// than cycle_stall_s, and again at every check until the cycle beats again. It stores a trip in the
// heartbeat, so that the cycle raises the fault watchdog_tripped when it wakes. It checks four times in
// cycle_stall_s. After its start it allocates nothing and waits only for time.
class TorqueWatchdog {
 public:
  // `cut` takes the torque away and must not block; both must outlive the watchdog.
  TorqueWatchdog(const WatchdogConfig& config, Heartbeat& heart, std::function<void()> cut);
  ~TorqueWatchdog();
  TorqueWatchdog(const TorqueWatchdog&) = delete;
  TorqueWatchdog& operator=(const TorqueWatchdog&) = delete;

  // Real-time settings that the computer did not permit, with the cure; empty if none.
  const std::string& warning() const noexcept { return warning_; }

  std::uint32_t trips() const noexcept { return trips_.load(std::memory_order_relaxed); }
  double longest_stall_s() const noexcept {
    return 1e-9 * static_cast<double>(longest_stall_ns_.load(std::memory_order_relaxed));
  }

 private:
  void watch() noexcept;

  std::int64_t stall_ns_;
  Heartbeat& heart_;
  std::function<void()> cut_;
  std::string warning_;
  std::atomic<bool> stopping_{false};
  std::atomic<std::uint32_t> trips_{0};
  std::atomic<std::int64_t> longest_stall_ns_{0};
  std::thread thread_;
};

}  // namespace sandhopper
