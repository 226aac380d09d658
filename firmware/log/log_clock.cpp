#include "firmware/log/log_clock.hpp"

#include <ctime>
#include <limits>

namespace sandhopper {
namespace {

std::int64_t now_ns(clockid_t clock) {
  timespec time{};
  ::clock_gettime(clock, &time);
  return std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
}

}  // namespace

std::int64_t sample_realtime_offset_ns() {
  constexpr int kReadings = 5;
  std::int64_t best_ns = std::numeric_limits<std::int64_t>::max();
  std::int64_t offset_ns = 0;
  for (int i = 0; i < kReadings; ++i) {
    const std::int64_t before_ns = now_ns(CLOCK_MONOTONIC);
    const std::int64_t real_ns = now_ns(CLOCK_REALTIME);
    const std::int64_t distance_ns = now_ns(CLOCK_MONOTONIC) - before_ns;
    if (distance_ns >= best_ns) continue;
    best_ns = distance_ns;
    offset_ns = real_ns - before_ns - distance_ns / 2;
  }
  return offset_ns;
}

}  // namespace sandhopper
