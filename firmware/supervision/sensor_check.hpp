#pragma once
#include <cstdint>

#include "firmware/supervision/counts.hpp"
#include "firmware/supervision/findings.hpp"

namespace sandhopper {

// Checks every sensor on a slow bus: fresh samples, often enough, with increasing time stamps and within
// range. Equal samples are a fault only if the sensor showed noise while the robot hung still; a sensor
// without noise (a simulation) may repeat its value.
class SensorCheck {
 public:
  struct Faults {
    Fault stale, stuck, out_of_range;
    double number;  // number of the device in the log
  };
  struct Limits {
    double age_s;
    double rate_Hz;  // least number of fresh cycles per second
    int stuck_samples;
    double range_samples;
    double range_leak;  // decrease of the out-of-range count per good value
  };
  SensorCheck(const Faults& faults, const Limits& limits) noexcept
      : faults_(faults), limits_(limits), out_of_range_(limits.range_leak) {}

  struct Seen {
    std::int64_t now_ns;
    std::int64_t time_ns;
    bool fresh;
    bool changed;   // the value differs from that of the previous sample
    bool in_range;  // and is a number
    bool starting;  // the daemon is starting: the first sample may not have arrived yet
    bool learning;  // the robot hangs or stands still, so the sensor's noise may be learned
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
