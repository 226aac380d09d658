#include "firmware/watchdog/torque_watchdog.hpp"

#include <fmt/format.h>
#include <pthread.h>
#include <sched.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <utility>

#include "drivers/clock.hpp"
#include "firmware/watchdog/stall_detector.hpp"

namespace sandhopper {
namespace {

constexpr std::int64_t kLooksPerStall = 4;

void sleep_until(std::int64_t time_ns) noexcept {
  const timespec until{time_ns / kNanosecondsPerSecond, time_ns % kNanosecondsPerSecond};
  while (::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
}

}  // namespace

TorqueWatchdog::TorqueWatchdog(const WatchdogConfig& config, Heartbeat& heart, std::function<void()> cut)
    : stall_ns_(to_ns(config.cycle_stall_s)),
      heart_(heart),
      cut_(std::move(cut)),
      thread_([this] { watch(); }) {
  ::pthread_setname_np(thread_.native_handle(), "watchdog");
  const sched_param parameters{config.priority};
  if (config.priority == 0) return;
  if (const int error = ::pthread_setschedparam(thread_.native_handle(), SCHED_FIFO, &parameters); error != 0)
    warning_ = fmt::format("watchdog without SCHED_FIFO {} ({}): raise `ulimit -r` or give CAP_SYS_NICE",
                           config.priority, std::strerror(error));
}

TorqueWatchdog::~TorqueWatchdog() {
  stopping_.store(true, std::memory_order_release);
  thread_.join();
}

void TorqueWatchdog::watch() noexcept {
  StallDetector detector;
  bool tripped = false;
  auto next_ns = monotonic_ns();
  while (!stopping_.load(std::memory_order_acquire)) {
    next_ns = std::max(next_ns + stall_ns_ / kLooksPerStall, monotonic_ns());
    sleep_until(next_ns);
    const auto stall_ns = detector.see(heart_, monotonic_ns());
    longest_stall_ns_.store(std::max(longest_stall_ns_.load(std::memory_order_relaxed), stall_ns),
                            std::memory_order_relaxed);
    if (stall_ns < stall_ns_) {
      tripped = false;
      continue;
    }
    // Trip before the cut, so that a cycle that wakes now does not send an old command.
    heart_.trip(stall_ns);
    cut_();
    if (!tripped) trips_.fetch_add(1, std::memory_order_relaxed);
    tripped = true;
  }
}

}  // namespace sandhopper
