#pragma once
#include <algorithm>

#include "drivers/motor_command.hpp"
#include "drivers/samples.hpp"

namespace sandhopper {

// Law of gains for a drive that takes a current only (servo), computed by the host from the newest status
// frame. The torque is limited to the robot's limit, which the damping of a hard landing would exceed. If the
// command has gains and the status frame is older than kHostLawAge_s the command is zero: gains times an old
// speed would drive the leg.
inline MotorCommand host_law(const MotorCommand& command, const MotorSample& state, std::int64_t now_ns,
                             double limit_Nm) noexcept {
  const bool gains = command.kp_Nm_per_rad != 0.0 || command.kd_Nm_s_per_rad != 0.0;
  double torque_Nm = command.torque_Nm;
  if (gains && (state.time_ns == 0 || to_s(now_ns - state.time_ns) > kHostLawAge_s)) return {};
  if (gains)
    torque_Nm += command.kp_Nm_per_rad * (command.position_rad - state.position_rad) +
                 command.kd_Nm_s_per_rad * (command.velocity_radps - state.velocity_radps);
  return {.torque_Nm = std::clamp(torque_Nm, -limit_Nm, limit_Nm)};
}

}  // namespace sandhopper
