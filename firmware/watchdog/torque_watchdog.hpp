#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <thread>

#include "firmware/watchdog/heartbeat.hpp"
#include "firmware/watchdog/watchdog_config.hpp"

namespace sandhopper {

// A thread of its own, above the cycle, that takes the torque away when the cycle stands still for longer
// than cycle_stall_s, and again every look until it beats again; the trip is left with the heartbeat, so that
// the cycle ends in the fault watchdog_tripped when it wakes. It looks four times in cycle_stall_s. After its
// start it allocates nothing and waits for nothing but time.
class TorqueWatchdog {
 public:
  // `cut` takes the torque away and must not block; both must outlive the watchdog.
  TorqueWatchdog(const WatchdogConfig& config, Heartbeat& heart, std::function<void()> cut);
  ~TorqueWatchdog();
  TorqueWatchdog(const TorqueWatchdog&) = delete;
  TorqueWatchdog& operator=(const TorqueWatchdog&) = delete;

  // What the machine did not grant, with its cure; empty: nothing.
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
