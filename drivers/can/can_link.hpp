#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "drivers/samples.hpp"

namespace sandhopper {

// State of a CAN interface as the kernel reports it (rtnetlink, linux/can/netlink.h). A virtual interface has
// no bit timing and no controller: those fields stay empty.
struct CanLink {
  bool up = false;
  std::uint32_t queue_length = 0;
  std::optional<std::uint32_t> bitrate;     // bit/s; 0: never set
  std::optional<BusState> state;            // empty while stopped or asleep, and for a virtual interface
  std::optional<std::uint32_t> restart_ms;  // delay of the restart after bus-off; 0: no automatic restart
  struct ErrorCounters {
    std::uint16_t transmit, receive;
  };
  std::optional<ErrorCounters> errors;  // of the controller, if its driver reports them
};

// Empty if there is no such interface or it is not a CAN interface. Needs no privileges. Throws DeviceError
// if the kernel does not answer.
std::optional<CanLink> can_link(const std::string& interface);

}  // namespace sandhopper
