#include "firmware/outbox.hpp"

#include <fmt/format.h>
#include <limits.h>
#include <poll.h>
#include <pthread.h>
#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <utility>

#include "drivers/clock.hpp"

namespace sandhopper {

Outbox::Outbox(int fd) : fd_(fd), thread_([this] { run(); }) {}

Outbox::~Outbox() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
    give_up_ns_ = monotonic_ns() + kPatience_ms * std::int64_t{1'000'000};
  }
  changed_.notify_one();
  thread_.join();
}

void Outbox::put(std::string line) {
  {
    const std::lock_guard lock(mutex_);
    if (lines_.size() < kMost)
      lines_.push_back(std::move(line));
    else
      ++lost_;
  }
  changed_.notify_one();
}

void Outbox::put_status(std::string line) {
  {
    const std::lock_guard lock(mutex_);
    status_ = std::move(line);
  }
  changed_.notify_one();
}

// Takes the next line; other lines come before the status. False if nothing is left and nothing will come.
bool Outbox::next(std::string& line) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return ending_ || !lines_.empty() || !status_.empty(); });
  if (!lines_.empty()) {
    line = std::move(lines_.front());
    lines_.pop_front();
    if (lines_.empty() && lost_ > 0)
      lines_.push_back(fmt::format(R"({{"lost_lines":{}}})", std::exchange(lost_, 0)));
    return true;
  }
  line = std::exchange(status_, {});
  return !line.empty();
}

// A pipe or terminal that is ready for writing accepts PIPE_BUF bytes without blocking.
bool Outbox::write_all(const std::string& line) {
  std::size_t done = 0;
  while (done < line.size()) {
    pollfd ready{fd_, POLLOUT, 0};
    const int count = ::poll(&ready, 1, kLook_ms);
    if (count > 0) {
      const auto written =
          ::write(fd_, line.data() + done, std::min<std::size_t>(line.size() - done, PIPE_BUF));
      if (written > 0) done += static_cast<std::size_t>(written);
      if (written < 0 && errno != EINTR && errno != EAGAIN) return false;
      continue;
    }
    const std::lock_guard lock(mutex_);
    if (monotonic_ns() > give_up_ns_) return false;
  }
  return true;
}

// The creating thread may have the cycle's priority, which threads inherit: return to ordinary scheduling.
void Outbox::run() {
  const sched_param ordinary{};
  ::pthread_setschedparam(::pthread_self(), SCHED_OTHER, &ordinary);
  ::pthread_setname_np(::pthread_self(), "outbox");
  bool reader_there = true;
  std::string line;
  while (next(line))
    if (reader_there) reader_there = write_all(line + '\n');
}

}  // namespace sandhopper
