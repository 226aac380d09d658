#pragma once
#include <cstdint>
#include <optional>
#include <string>

namespace sandhopper {

// Interrupt coalescing of a CAN controller's driver (ethtool -c, the values "-irq", used by mcp251xfd). A
// received frame is late by up to `usecs`. The echoes of transmitted frames are late, too, so the driver
// takes a working bus for one that holds its frames back.
struct CanCoalescing {
  struct Direction {
    std::uint32_t usecs = 0;   // longest wait [us]; 0: none
    std::uint32_t frames = 0;  // this many frames end the wait; 0 and 1: no wait
    bool waits() const noexcept { return usecs > 0 && frames != 1; }
  };
  Direction receive;
  Direction transmit;
};

// Empty if the interface does not exist or its driver has no such setting.
std::optional<CanCoalescing> can_coalescing(const std::string& interface);

}  // namespace sandhopper
