#include "firmware/transmit_limits.hpp"

#include <algorithm>
#include <cmath>

namespace sandhopper {
namespace {

constexpr double kCyclesPerSecond = 1000.0;
constexpr int kDampingCycles = 8;

transmit::Dialect guarded_dialect(Dialect dialect) noexcept {
  switch (dialect) {
    case Dialect::mit:
      return transmit::Dialect::mit;
    case Dialect::servo:
      return transmit::Dialect::servo;
    case Dialect::v3:
      break;
  }
  return transmit::Dialect::v3;
}

transmit::MotorLimits motor_limits(const CubeMarsConfig& motor, const LimitsConfig& limits) noexcept {
  // After motor_reply_misses cycles without a reply the fault ends the torque; one more frame is for a reply
  // that is on its way. Servo status frames come less often, and the damping computed from them continues for
  // a short time, so servo allows more frames.
  const int misses = limits.motor_reply_misses + 1;
  const bool servo = motor.dialect == Dialect::servo;
  const auto cycles_per_reply = static_cast<int>(std::ceil(kCyclesPerSecond / replies_per_s(motor)));
  return {.dialect = guarded_dialect(motor.dialect),
          .can_id = static_cast<std::uint32_t>(motor.can_id),
          .master_id = static_cast<std::uint32_t>(motor.master_id),
          .position_range_rad = motor.position_range_rad,
          .velocity_range_radps = motor.velocity_range_radps,
          .kp_range_Nm_per_rad = motor.kp_range_Nm_per_rad,
          .kd_range_Nm_s_per_rad = motor.kd_range_Nm_s_per_rad,
          .torque_range_Nm = motor.torque_range_Nm,
          .sign = motor.sign,
          .gear_ratio = motor.gear_ratio,
          .zero_offset_rad = motor.zero_offset_rad,
          .torque_constant_Nm_per_A = motor.torque_constant_Nm_per_A,
          .drive_torque_constant_Nm_per_A = motor.drive_torque_constant_Nm_per_A,
          .pole_pairs = motor.pole_pairs,
          .drive_reduction = motor.drive_reduction,
          .torque_Nm = limits.motor_torque_Nm,
          .kp_Nm_per_rad = limits.fault_hold_stiffness_Nm_per_rad,
          .kd_Nm_s_per_rad = limits.fault_damping_Nm_s_per_rad,
          .speed_radps = limits.motor_speed_radps,
          .angle_min_rad = limits.leg_angle_min_rad,
          .angle_max_rad = limits.leg_angle_max_rad,
          .status_rate_Hz = servo ? motor.status_rate_Hz : 0.0,
          .most_unanswered = std::max(misses + cycles_per_reply, servo ? kDampingCycles : 0)};
}

}  // namespace

transmit::Limits transmit_limits(const CanConfig& can, const LimitsConfig& limits) noexcept {
  transmit::Limits out{.motor_count = static_cast<std::size_t>(can.motor_count),
                       .motor = {},
                       .bus_share = kMostBusLoad - can.other_load};
  for (std::size_t i = 0; i < kMotorCount; ++i) out.motor[i] = motor_limits(can.motor[i], limits);
  return out;
}

}  // namespace sandhopper
