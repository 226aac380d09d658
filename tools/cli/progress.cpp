#include "tools/cli/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace sandhopper::cli {
namespace {

using std::chrono::milliseconds;
constexpr milliseconds kQuietFor{2000};
constexpr milliseconds kRedrawEvery{100};
constexpr std::size_t kBarWidth = 30;

}  // namespace

Progress::Progress(std::string label, double total)
    : label_(std::move(label)), total_(total), on_terminal_(::isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (shown_) std::fputs("\r\033[K", stderr);
}

void Progress::at(double done) {
  if (!on_terminal_) return;
  const auto now = Clock::now();
  if (now - start_ < kQuietFor || now - drawn_ < kRedrawEvery) return;
  drawn_ = now;
  shown_ = true;
  const double share = total_ > 0.0 ? std::clamp(done / total_, 0.0, 1.0) : 0.0;
  const auto filled = static_cast<std::size_t>(share * static_cast<double>(kBarWidth));
  const auto elapsed_s = std::chrono::duration<double>(now - start_).count();
  const auto left =
      share > 0.0 ? fmt::format(", {:.0f} s left", elapsed_s / share - elapsed_s) : std::string();
  std::fputs(fmt::format("\r{} [{}{}] {:3.0f} %{}\033[K", label_, std::string(filled, '#'),
                         std::string(kBarWidth - filled, '.'), share * 100.0, left)
                 .c_str(),
             stderr);
  std::fflush(stderr);
}

}  // namespace sandhopper::cli
