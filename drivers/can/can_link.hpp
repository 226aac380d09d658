#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "drivers/samples.hpp"

namespace sandhopper {

// What the kernel says of a CAN interface (rtnetlink, linux/can/netlink.h). A virtual one has neither bit
// timing nor controller: those stay empty.
struct CanLink {
  bool up = false;
  std::uint32_t queue_length = 0;
  std::optional<std::uint32_t> bitrate;     // bit/s; 0: never set
  std::optional<BusState> state;            // none while stopped or asleep, and of a virtual one
  std::optional<std::uint32_t> restart_ms;  // after bus-off; 0: never by itself
  struct ErrorCounters {
    std::uint16_t transmit, receive;
  };
  std::optional<ErrorCounters> errors;  // of the controller, where its driver tells them
};

// Empty where there is no such interface, or it is not a CAN interface. Needs no rights. Throws DeviceError
// where the kernel does not answer.
std::optional<CanLink> can_link(const std::string& interface);

}  // namespace sandhopper
