#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "config/fields.hpp"

namespace sandhopper {

// Scheduling of the cycle's thread. Priorities: the cycle at `priority`, acquisition threads below it, kernel
// threads of the buses that serve it above it.
struct RealTimeConfig {
  int priority = 80;        // SCHED_FIFO; 0: ordinary scheduling
  int cpu = -1;             // pinned to this CPU; -1: any
  bool lock_memory = true;  // mlockall, so that nothing is paged out
  int stack_prefault_kB = 512;
  bool hold_cpu_awake = true;  // keeps /dev/cpu_dma_latency at 0

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("priority", self.priority, Range{0, 98});
    visit("cpu", self.cpu, Range{-1, 1023});
    visit("lock_memory", self.lock_memory);
    visit("stack_prefault_kB", self.stack_prefault_kB, Range{0, 7000});
    visit("hold_cpu_awake", self.hold_cpu_awake);
  }
};

// Makes the calling thread real-time as configured, until the object is destroyed. Settings that the computer
// does not permit are listed in warnings(), each with its cure; the thread continues without them.
class RealTimeThread {
 public:
  explicit RealTimeThread(const RealTimeConfig& config);
  ~RealTimeThread();
  RealTimeThread(const RealTimeThread&) = delete;
  RealTimeThread& operator=(const RealTimeThread&) = delete;
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  std::vector<std::string> warnings_;
  int latency_fd_ = -1;
};

// Histogram of the cycle's wake-up latency, in 1 us bins up to 1 ms and one bin for the rest. Allocates
// nothing.
class LatencyHistogram {
 public:
  static constexpr std::size_t kBins = 1001;
  // Coarse bins for a quick overview: below 1 us, below 2, below 4, … below 1024 us, and the rest.
  static constexpr std::size_t kOctaves = 12;
  void add(std::int64_t late_ns) noexcept;
  std::uint64_t count() const noexcept { return count_; }
  double largest_us() const noexcept { return static_cast<double>(largest_ns_) * 1e-3; }
  double last_us() const noexcept { return static_cast<double>(last_ns_) * 1e-3; }
  const std::array<std::uint64_t, kOctaves>& octaves() const noexcept { return octaves_; }
  // Upper edge [us] of the bin in which the cumulative share of the counts reaches `share`.
  double quantile_us(double share) const noexcept;
  // [[n, cycles], …] of the non-empty bins; bin n counts n-1 to n us, the last one everything above.
  std::string as_json() const;

 private:
  std::array<std::uint64_t, kBins> bins_{};
  std::array<std::uint64_t, kOctaves> octaves_{};
  std::uint64_t count_ = 0;
  std::int64_t last_ns_ = 0;
  std::int64_t largest_ns_ = 0;
};

// Clock of the cycle's time grid: CLOCK_MONOTONIC, or a test's time.
class TimeSource {
 public:
  virtual ~TimeSource() = default;
  virtual std::int64_t now_ns() noexcept = 0;
  virtual void sleep_until(std::int64_t time_ns) noexcept = 0;
};
TimeSource& monotonic_time() noexcept;

// The cycle's time grid on CLOCK_MONOTONIC: whole multiples of the period. A grid point that has passed when
// the cycle ends counts as an overrun and is skipped. Missed cycles are not made up for.
class CycleClock {
 public:
  explicit CycleClock(std::int64_t period_ns, TimeSource& time = monotonic_time());

  // Sleeps until the next grid point and returns it.
  std::int64_t wait() noexcept;
  std::uint64_t cycle() const noexcept { return cycle_; }
  std::uint32_t overruns() const noexcept { return overruns_; }
  const LatencyHistogram& latency() const noexcept { return latency_; }

 private:
  TimeSource& time_;
  std::int64_t period_ns_;
  std::int64_t next_ns_;
  std::uint64_t cycle_ = 0;
  std::uint32_t overruns_ = 0;
  LatencyHistogram latency_;
};

}  // namespace sandhopper
