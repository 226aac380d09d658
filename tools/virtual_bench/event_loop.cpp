#include "tools/virtual_bench/event_loop.hpp"

#include <algorithm>
#include <cerrno>
#include <system_error>

#include "drivers/clock.hpp"

namespace sandhopper::bench {

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
    if (on_wake_) on_wake_();
    run_timers();
    run_readable();
  }
}

void EventLoop::wait() {
  timespec timeout{};
  if (!timers_.empty()) {
    const auto left_ns = std::max<std::int64_t>(timers_.top().time_ns - monotonic_ns(), 0);
    timeout = {left_ns / kNanosecondsPerSecond, left_ns % kNanosecondsPerSecond};
  }
  const int ready = ::ppoll(polled_.data(), polled_.size(), timers_.empty() ? nullptr : &timeout, nullptr);
  if (ready >= 0) return;
  if (errno != EINTR) throw std::system_error(errno, std::generic_category(), "ppoll");
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
