#pragma once
#include <cstdint>
#include <ctime>
#include <limits>

namespace sandhopper {

inline constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;

inline std::int64_t to_ns(const timespec& time) noexcept {
  return static_cast<std::int64_t>(time.tv_sec) * kNanosecondsPerSecond + time.tv_nsec;
}

inline std::int64_t to_ns(double seconds) noexcept { return static_cast<std::int64_t>(seconds * 1e9); }

inline std::int64_t clock_ns(clockid_t clock) noexcept {
  timespec now{};
  ::clock_gettime(clock, &now);
  return to_ns(now);
}

inline std::int64_t monotonic_ns() noexcept { return clock_ns(CLOCK_MONOTONIC); }

// CLOCK_REALTIME minus CLOCK_MONOTONIC now, for kernel time stamps in real time. Uses the shortest of up to
// three readings, because an interrupted reading is inaccurate.
inline std::int64_t realtime_offset_ns() noexcept {
  std::int64_t offset = 0;
  std::int64_t shortest = std::numeric_limits<std::int64_t>::max();
  for (int i = 0; i < 3 && shortest > 1000; ++i) {
    const auto before = monotonic_ns();
    const auto realtime = clock_ns(CLOCK_REALTIME);
    const auto took = monotonic_ns() - before;
    if (took >= shortest) continue;
    shortest = took;
    offset = realtime - (before + took / 2);
  }
  return offset;
}

inline void sleep_ns(std::int64_t duration) noexcept {
  timespec time{duration / kNanosecondsPerSecond, duration % kNanosecondsPerSecond};
  while (::nanosleep(&time, &time) != 0) {
  }
}

}  // namespace sandhopper
