#pragma once
#include <poll.h>

#include <cstdint>
#include <functional>
#include <queue>
#include <vector>

#include "drivers/unique_fd.hpp"

namespace sandhopper::bench {

// One thread that sleeps until the next timer or readable file descriptor. All emulated devices live on it,
// so nothing needs a lock and the order of what happens depends on nothing but time.
class EventLoop {
 public:
  EventLoop();  // throws std::system_error

  using Action = std::function<void()>;

  // CLOCK_MONOTONIC when the loop last woke; the instant at which an action acts.
  std::int64_t now_ns() const noexcept { return now_ns_; }

  // Called whenever `fd` can be read. The caller keeps the descriptor open until forget().
  void watch(int fd, Action action);
  void forget(int fd);

  // Once, at `time_ns` or as soon as possible after it; equal times in the order of the calls.
  void at(std::int64_t time_ns, Action action);

  // Returns after stop().
  void run();
  void stop() noexcept { running_ = false; }

 private:
  struct Timer {
    std::int64_t time_ns;
    std::uint64_t order;
    Action action;
    bool operator>(const Timer& other) const noexcept {
      return time_ns != other.time_ns ? time_ns > other.time_ns : order > other.order;
    }
  };

  void set_alarm();
  void wait();
  void run_timers();
  void run_readable();

  UniqueFd alarm_;  // goes off at the first timer's time
  std::int64_t alarm_ns_ = -1;
  std::vector<pollfd> polled_;
  std::vector<Action> action_;  // one for each of `polled_`
  std::priority_queue<Timer, std::vector<Timer>, std::greater<>> timers_;
  std::uint64_t order_ = 0;
  std::int64_t now_ns_ = 0;
  bool running_ = false;
};

}  // namespace sandhopper::bench
