#pragma once
#include <cstdint>

#include "firmware/supervision/counts.hpp"
#include "firmware/supervision/findings.hpp"

namespace sandhopper {

// What is asked of every sensor on a slow bus: fresh, often enough, stamps that go forward, values that
// change when they did before, within range. Stuck is judged only of a sensor whose noise was seen while the
// robot hung still: one without noise (a simulation) may well repeat itself.
class SensorCheck {
 public:
  struct Faults {
    Fault stale, stuck, out_of_range;
    double number;  // of the device, in the log
  };
  struct Limits {
    double age_s;
    double rate_Hz;  // fresh cycles a second, at least
    int stuck_samples;
    double range_samples;
    double range_leak;  // of the count of values out of range, per good one
  };
  SensorCheck(const Faults& faults, const Limits& limits) noexcept
      : faults_(faults), limits_(limits), out_of_range_(limits.range_leak) {}

  struct Seen {
    std::int64_t now_ns;
    std::int64_t time_ns;
    bool fresh;
    bool changed;   // against the sample before
    bool in_range;  // and a number
    bool starting;  // the daemon: the first sample may still be on its way
    bool learning;  // the robot hangs or stands still: noise may be learned
  };
  void see(const Seen& seen, Findings& findings) noexcept;

 private:
  static constexpr std::size_t kWindow_cycles = 200;
  static constexpr int kNoisy = 50;
  static constexpr std::int64_t kFuture_ns = 5'000'000;

  Faults faults_;
  Limits limits_;
  std::int64_t last_time_ns_ = 0;
  int changes_ = 0;
  int same_ = 0;
  LeakyCount out_of_range_;
  LeakyCount wrong_time_{0.25};
  RecentShare<kWindow_cycles> share_;
};

}  // namespace sandhopper
