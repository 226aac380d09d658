#pragma once
#include <array>
#include <cstdint>
#include <string>

#include "config/fields.hpp"

namespace sandhopper {

// Source of a sample's time: the arrival of its frame, or the companion's clock mapped to ours.
enum class TofClock : std::uint8_t { arrival, companion };
template <>
struct EnumNames<TofClock> {
  static constexpr std::array<std::string_view, 2> value{"arrival", "companion"};
};

// AFBR-S50 behind its companion controller. Body height = range + mount_offset_m.
struct TofConfig {
  std::string device = "/dev/ttyACM0";
  int baud = 1'000'000;
  double frame_time_s = 0.002;
  bool dual_frequency_mode = false;  // adds frames of delay, and errors during fast changes
  bool smart_power_save = false;
  TofClock clock = TofClock::arrival;
  double latency_s = 0.002;     // from the measurement to the arrival of its frame
  double mount_offset_m = 0.0;  // height of the hip axis over the sensor's reference plane
  double range_min_m = 0.02;    // a range outside gives no measurement
  double range_max_m = 3.0;
  int thread_priority = 50;  // SCHED_FIFO; 0: ordinary scheduling

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("device", self.device);
    visit("baud", self.baud, Range{115200, 2e6});
    visit("frame_time_s", self.frame_time_s, Range{0.0003, 1.0});
    visit("dual_frequency_mode", self.dual_frequency_mode);
    visit("smart_power_save", self.smart_power_save);
    visit("clock", self.clock);
    visit("latency_s", self.latency_s, Range{0, 0.1});
    visit("mount_offset_m", self.mount_offset_m, Range{-1, 1});
    visit("range_min_m", self.range_min_m, Range{0, 10});
    visit("range_max_m", self.range_max_m, Range{0.05, 50});
    visit("thread_priority", self.thread_priority, Range{0, 98});
  }

  template <class Problem>
  void check(Problem&& problem) const {
    const bool known = baud == 115200 || baud == 230400 || baud == 460800 || baud == 500000 ||
                       baud == 921600 || baud == 1000000 || baud == 1500000 || baud == 2000000;
    if (!known)
      problem("baud", "must be 115200, 230400, 460800, 500000, 921600, 1000000, 1500000 or 2000000");
    // A result is 23 to 30 bytes of 10 bits.
    if (300.0 / frame_time_s > baud)
      problem("baud", "too slow for the frame time: a result takes up to 300 bits on the wire");
    if (range_min_m >= range_max_m) problem("range_min_m", "must be below range_max_m");
  }
};

}  // namespace sandhopper
