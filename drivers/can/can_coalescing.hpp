#pragma once
#include <cstdint>
#include <optional>
#include <string>

namespace sandhopper {

// How a CAN controller's driver collects events before it interrupts (ethtool -c, the values "-irq", used by
// mcp251xfd). A frame that waits for its interrupt is late by up to `usecs`; of transmitted frames the echo
// is late, so the driver takes a bus that works for one that holds its frames back.
struct CanCoalescing {
  struct Direction {
    std::uint32_t usecs = 0;   // longest wait [us]; 0: none
    std::uint32_t frames = 0;  // as many frames end the wait; 0 and 1: none
    bool waits() const noexcept { return usecs > 0 && frames != 1; }
  };
  Direction receive;
  Direction transmit;
};

// Empty where the interface does not exist or its driver has no such setting.
std::optional<CanCoalescing> can_coalescing(const std::string& interface);

}  // namespace sandhopper
