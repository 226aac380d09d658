#include "tools/cli/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <condition_variable>
#include <cstdio>
#include <mutex>

namespace sandhopper::cli {
namespace {

using std::chrono::milliseconds;
constexpr milliseconds kQuietFor{2000};
constexpr milliseconds kRedrawEvery{100};
constexpr milliseconds kLineEvery{10'000};
constexpr std::size_t kBarWidth = 30;

}  // namespace

Progress::Progress(std::string label, double total)
    : label_(std::move(label)), total_(total), on_terminal_(::isatty(STDERR_FILENO) == 1) {
  if (!on_terminal_) teller_ = std::jthread([this](const std::stop_token& stop) { tell(stop); });
}

Progress::~Progress() {
  if (shown_) std::fputs("\r\033[K", stderr);
}

void Progress::at(double done) {
  done_ = done;
  if (on_terminal_) draw();
}

void Progress::at(double done, const std::string& step) {
  {
    const std::lock_guard lock(of_step_);
    step_ = step;
  }
  at(done);
}

std::string Progress::step() const {
  const std::lock_guard lock(of_step_);
  return step_.empty() ? "" : fmt::format(" {},", step_);
}

double Progress::share() const { return total_ > 0.0 ? std::clamp(done_ / total_, 0.0, 1.0) : 0.0; }

double Progress::elapsed_s() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

void Progress::draw() {
  const auto now = Clock::now();
  if (now - start_ < kQuietFor || now - drawn_ < kRedrawEvery) return;
  drawn_ = now;
  shown_ = true;
  const auto filled = static_cast<std::size_t>(share() * static_cast<double>(kBarWidth));
  const auto left =
      share() > 0.0 ? fmt::format(", {:.0f} s left", elapsed_s() / share() - elapsed_s()) : std::string();
  std::fputs(fmt::format("\r{}{} [{}{}] {:3.0f} %{}\033[K", label_, step(), std::string(filled, '#'),
                         std::string(kBarWidth - filled, '.'), share() * 100.0, left)
                 .c_str(),
             stderr);
  std::fflush(stderr);
}

void Progress::tell(const std::stop_token& stop) const {
  std::mutex mutex;
  std::condition_variable_any ended;
  std::unique_lock lock(mutex);
  for (milliseconds wait = kQuietFor;
       !ended.wait_for(lock, stop, wait, [&] { return stop.stop_requested(); }); wait = kLineEvery) {
    const auto part = total_ > 0.0 ? fmt::format(" {:.0f} %,", share() * 100.0) : std::string();
    std::fputs(fmt::format("{}:{}{} {:.0f} s so far\n", label_, part, step(), elapsed_s()).c_str(), stderr);
    std::fflush(stderr);
  }
}

}  // namespace sandhopper::cli
