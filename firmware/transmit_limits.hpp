#pragma once
#include "drivers/can/can_config.hpp"
#include "drivers/transmit_guard/transmit_guard.hpp"
#include "firmware/controller_config.hpp"
#include "firmware/fault.hpp"

namespace sandhopper {

// Converts the robot's configuration to the transmit guard's limits.
transmit::Limits transmit_limits(const CanConfig& can, const LimitsConfig& limits) noexcept;

// Commands that the latched fault's reaction still allows.
constexpr transmit::Allowance allowance_of(Fault latched) noexcept {
  switch (entry_of(latched).reaction) {
    case Reaction::none:
    case Reaction::stop:
      return transmit::Allowance::motion;
    case Reaction::hold:
      return transmit::Allowance::holding;
    case Reaction::damp:
      return transmit::Allowance::damping;
    case Reaction::limp:
      break;
  }
  return transmit::Allowance::no_torque;
}

}  // namespace sandhopper
