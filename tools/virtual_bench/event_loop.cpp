#include "tools/virtual_bench/event_loop.hpp"

#include <sys/timerfd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

#include "drivers/clock.hpp"

namespace sandhopper::bench {

EventLoop::EventLoop() : alarm_(::timerfd_create(CLOCK_MONOTONIC, TFD_CLOEXEC | TFD_NONBLOCK)) {
  if (!alarm_) throw std::system_error(errno, std::generic_category(), "timerfd_create");
  watch(alarm_.get(), [] {});  // setting it again silences it
}

void EventLoop::watch(int fd, Action action) {
  polled_.push_back({.fd = fd, .events = POLLIN, .revents = 0});
  action_.push_back(std::move(action));
}

void EventLoop::forget(int fd) {
  const auto found = std::ranges::find(polled_, fd, &pollfd::fd);
  if (found == polled_.end()) return;
  action_.erase(action_.begin() + (found - polled_.begin()));
  polled_.erase(found);
}

void EventLoop::at(std::int64_t time_ns, Action action) {
  timers_.push({time_ns, order_++, std::move(action)});
}

void EventLoop::run() {
  now_ns_ = monotonic_ns();
  for (running_ = true; running_;) {
    wait();
    now_ns_ = monotonic_ns();
    run_timers();
    run_readable();
  }
}

// By absolute time, and only when it changes: a system call costs 12 us on the bench.
void EventLoop::set_alarm() {
  const auto wanted_ns = timers_.empty() ? 0 : std::max<std::int64_t>(timers_.top().time_ns, 1);
  if (wanted_ns == alarm_ns_) return;
  alarm_ns_ = wanted_ns;
  const itimerspec alarm{.it_interval = {},
                         .it_value = {alarm_ns_ / kNanosecondsPerSecond, alarm_ns_ % kNanosecondsPerSecond}};
  ::timerfd_settime(alarm_.get(), TFD_TIMER_ABSTIME, &alarm, nullptr);
}

void EventLoop::wait() {
  set_alarm();
  if (::poll(polled_.data(), polled_.size(), -1) >= 0) return;
  if (errno != EINTR) throw std::system_error(errno, std::generic_category(), "poll");
  for (auto& polled : polled_) polled.revents = 0;
}

void EventLoop::run_timers() {
  while (running_ && !timers_.empty() && timers_.top().time_ns <= now_ns_) {
    auto action = std::move(const_cast<Timer&>(timers_.top()).action);
    timers_.pop();
    action();
  }
}

void EventLoop::run_readable() {
  // By descriptor, because an action may add and forget others.
  std::vector<int> ready;
  for (const auto& polled : polled_)
    if (polled.revents != 0) ready.push_back(polled.fd);
  for (const int fd : ready) {
    const auto found = std::ranges::find(polled_, fd, &pollfd::fd);
    if (!running_ || found == polled_.end()) continue;
    auto action = action_[static_cast<std::size_t>(found - polled_.begin())];
    action();
  }
}

}  // namespace sandhopper::bench
