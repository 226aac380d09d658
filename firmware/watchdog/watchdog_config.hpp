#pragma once
#include <string>

#include "config/fields.hpp"

namespace sandhopper {

// Watchdogs of the cycle: a thread that takes the torque away, and the kernel's watchdog that resets the
// computer.
struct WatchdogConfig {
  double cycle_stall_s = 0.020;          // a longer standstill of the cycle takes the torque away
  int priority = 90;                     // SCHED_FIFO, above the cycle's; 0: ordinary scheduling
  std::string device = "/dev/watchdog";  // the kernel's watchdog, fed while the cycle beats; empty: none
  int device_timeout_s = 5;              // the computer is reset if it was not fed for this long

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("cycle_stall_s", self.cycle_stall_s, Range{0.003, 10.0});
    visit("priority", self.priority, Range{0, 98});
    visit("device", self.device);
    visit("device_timeout_s", self.device_timeout_s, Range{1, 600});
  }
};

}  // namespace sandhopper
