#include "firmware/fault_reaction.hpp"

#include <cmath>

namespace sandhopper {

bool FaultReaction::fresh(const SensorFrame& frame, std::size_t motor) const noexcept {
  return to_s(frame.time_ns - frame.motor[motor].time_ns) <= kHostLawAge_s;
}

bool FaultReaction::can_damp(const SensorFrame& frame, std::size_t motor) const noexcept {
  return config_.law_in_drive[motor] || fresh(frame, motor);
}

void FaultReaction::begin(const SensorFrame& frame, bool energised) noexcept {
  energised_ = can_hold_ = energised;
  for (std::size_t i = 0; i < motors(); ++i) {
    hold_angle_rad_[i] = frame.motor[i].position_rad;
    can_hold_ = can_hold_ && fresh(frame, i) && std::isfinite(hold_angle_rad_[i]);
  }
}

void FaultReaction::write(const SensorFrame& frame, Reaction reaction, double time_s,
                          Command& command) noexcept {
  const auto& limits = config_.limits;
  const double hold_s = reaction == Reaction::hold ? limits.fault_hold_s : 0.0;
  const double damp_s = reaction == Reaction::hold || reaction == Reaction::damp ? limits.fault_damp_s : 0.0;
  bool any = false;
  for (std::size_t i = 0; i < motors(); ++i) {
    any = any || can_damp(frame, i);
    can_hold_ = can_hold_ && can_damp(frame, i);
  }
  energised_ = energised_ && any && time_s < hold_s + damp_s;
  command.drive = energised_ ? DriveRequest::run : DriveRequest::off;
  if (!energised_) return;
  for (std::size_t i = 0; i < motors(); ++i) {
    if (!can_damp(frame, i)) continue;
    auto& motor = command.motor[i];
    motor.kd_Nm_s_per_rad = limits.fault_damping_Nm_s_per_rad;
    if (time_s >= hold_s || !can_hold_) continue;
    motor.kp_Nm_per_rad = limits.fault_hold_stiffness_Nm_per_rad;
    motor.position_rad = hold_angle_rad_[i];
  }
}

}  // namespace sandhopper
