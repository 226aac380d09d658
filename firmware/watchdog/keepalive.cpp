#include "firmware/watchdog/keepalive.hpp"

#include <fmt/format.h>
#include <pthread.h>
#include <systemd/sd-daemon.h>

#include <algorithm>
#include <utility>

#include "drivers/clock.hpp"

namespace sandhopper {
namespace {

constexpr std::int64_t kLongest_ns = 500'000'000;  // longest time between two checks

std::int64_t period_of(const KernelWatchdog& kernel, std::uint64_t service_us) {
  std::int64_t period_ns = kLongest_ns;
  if (kernel.armed()) period_ns = std::min(period_ns, kernel.timeout_s() * kNanosecondsPerSecond / 4);
  if (service_us > 0) period_ns = std::min(period_ns, static_cast<std::int64_t>(service_us) * 1000 / 2);
  return period_ns;
}

}  // namespace

Keepalive::Keepalive(const WatchdogConfig& config, const Heartbeat& heart, std::function<void()> also)
    : heart_(heart), also_(std::move(also)), kernel_(config.device, config.device_timeout_s) {
  if (::sd_watchdog_enabled(0, &service_period_us_) <= 0) service_period_us_ = 0;
  period_ns_ = period_of(kernel_, service_period_us_);
  thread_ = std::thread([this] { run(); });
}

Keepalive::~Keepalive() {
  stopping_.store(true, std::memory_order_release);
  thread_.join();
  ::sd_notify(0, "STOPPING=1\nSTATUS=drives off, closing the log");
}

void Keepalive::run() {
  ::pthread_setname_np(::pthread_self(), "keepalive");
  constexpr std::int64_t kStep_ns = 10'000'000;  // short, so that the thread ends soon when asked
  std::uint64_t last_beats = 0;
  bool ready = false;
  std::int64_t next_ns = 0;
  while (!stopping_.load(std::memory_order_acquire)) {
    sleep_ns(std::min(kStep_ns, period_ns_));
    if (also_) also_();
    const bool beats = heart_.beating() && heart_.beats() != last_beats;
    if (!beats || (ready && monotonic_ns() < next_ns)) continue;
    next_ns = monotonic_ns() + period_ns_;
    last_beats = heart_.beats();
    if (!ready) ::sd_notify(0, "READY=1");
    ready = true;
    kernel_.feed();
    if (service_period_us_ > 0) ::sd_notify(0, "WATCHDOG=1");
    tell_state();
  }
}

void Keepalive::tell_state() {
  auto status = fmt::format("STATUS={}", name_of(heart_.state()));
  if (heart_.fault() != Fault::none) status += fmt::format(", fault {}", name_of(heart_.fault()));
  if (status == sent_status_) return;
  ::sd_notify(0, status.c_str());
  sent_status_ = std::move(status);
}

}  // namespace sandhopper
