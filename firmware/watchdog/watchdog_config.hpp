#pragma once
#include <string>

#include "config/fields.hpp"

namespace sandhopper {

// What watches the cycle from outside: a thread that takes the torque away, and the kernel's watchdog that
// resets the computer.
struct WatchdogConfig {
  double cycle_stall_s = 0.020;          // the cycle stands still for this long: torque is taken away
  int priority = 90;                     // SCHED_FIFO, above the cycle's; 0: ordinary scheduling
  std::string device = "/dev/watchdog";  // kernel's watchdog, fed while the cycle beats; empty: none
  int device_timeout_s = 5;              // the computer is reset when it was not fed for so long

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("cycle_stall_s", self.cycle_stall_s, Range{0.003, 10.0});
    visit("priority", self.priority, Range{0, 98});
    visit("device", self.device);
    visit("device_timeout_s", self.device_timeout_s, Range{1, 600});
  }
};

}  // namespace sandhopper
