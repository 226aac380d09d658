#pragma once
#include <algorithm>

#include "drivers/motor_command.hpp"
#include "drivers/samples.hpp"

namespace sandhopper {

// For a drive that takes a current only (servo): its law worked out here, and its torque within the robot's
// limit, which a hard landing on full damping would pass. Without a state the command stays as it is.
inline MotorCommand host_law(const MotorCommand& command, const MotorSample& state,
                             double limit_Nm) noexcept {
  if (state.time_ns == 0) return command;
  const double torque_Nm = command.torque_Nm +
                           command.kp_Nm_per_rad * (command.position_rad - state.position_rad) +
                           command.kd_Nm_s_per_rad * (command.velocity_radps - state.velocity_radps);
  return {.torque_Nm = std::clamp(torque_Nm, -limit_Nm, limit_Nm)};
}

}  // namespace sandhopper
