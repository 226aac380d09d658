#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "firmware/watchdog/heartbeat.hpp"
#include "firmware/watchdog/kernel_watchdog.hpp"
#include "firmware/watchdog/watchdog_config.hpp"

namespace sandhopper {

// Reports the beats of the cycle to the kernel's watchdog and, under systemd, to the service manager
// (sd_notify(3): READY=1, STATUS=, WATCHDOG=1 twice in WATCHDOG_USEC, STOPPING=1). It runs at ordinary
// priority on purpose: a computer on which it gets no time has also stalled. While the cycle stands still, or
// before it has begun, nothing is reported; then systemd ends the program and the kernel resets the computer.
class Keepalive {
 public:
  // `also` is called on the same thread about every 10 ms, whether the cycle beats or not.
  Keepalive(const WatchdogConfig& config, const Heartbeat& heart, std::function<void()> also = {});
  // Reports that the service stops, and disarms the kernel's watchdog.
  ~Keepalive();
  Keepalive(const Keepalive&) = delete;
  Keepalive& operator=(const Keepalive&) = delete;

  const std::string& warning() const noexcept { return kernel_.warning(); }

 private:
  void run();
  void tell_state();

  const Heartbeat& heart_;
  std::function<void()> also_;
  KernelWatchdog kernel_;
  std::uint64_t service_period_us_ = 0;  // 0: no service manager asks for it
  std::int64_t period_ns_;
  std::string sent_status_;
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

}  // namespace sandhopper
