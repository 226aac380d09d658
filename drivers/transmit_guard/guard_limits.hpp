#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "drivers/samples.hpp"

// Plain numbers in a namespace of their own. Nothing of the motor driver is used here, so that a mistake of
// the driver is not repeated in the guard.
namespace sandhopper::transmit {

// Protocol of a drive's board: V1/V2 in MIT mode, V1/V2 in servo mode, V3. No two of them have the same
// frames (the maker's AK Series Module Driver User Manual V1.0.18 for the first two, V3.0.1 for the third).
enum class Dialect : std::uint8_t { mit, servo, v3 };

// One drive as it is wired and configured, and the limits of its commands. All limits are those of the link.
struct MotorLimits {
  Dialect dialect = Dialect::mit;
  std::uint32_t can_id = 1;
  std::uint32_t master_id = 0;  // identifier of replies (mit); 0 and can_id are accepted, too

  // Full scales of the drive's fields, at its output: position, velocity and torque from -range to +range,
  // gains from 0 to range.
  double position_range_rad = 12.5;
  double velocity_range_radps = 50.0;
  double kp_range_Nm_per_rad = 500.0;
  double kd_range_Nm_s_per_rad = 5.0;
  double torque_range_Nm = 18.0;

  // From the drive's output to the link: angle = zero_offset + sign * position / gear_ratio. The torque at
  // the drive's output is torque_constant * current. The drive converts a torque field into a current with
  // drive_torque_constant.
  int sign = 1;
  double gear_ratio = 1.0;
  double zero_offset_rad = 0.0;
  double torque_constant_Nm_per_A = 0.0868;
  double drive_torque_constant_Nm_per_A = 0.0868;
  int pole_pairs = 21;
  double drive_reduction = 1.0;

  double torque_Nm = 2.8;        // feed-forward torque, including the part from the velocity set-point
  double kp_Nm_per_rad = 15.0;   // stiffness
  double kd_Nm_s_per_rad = 0.3;  // damping
  double speed_radps = 40.0;     // velocity set-point
  double angle_min_rad = 0.15;   // position set-point, if the command has stiffness
  double angle_max_rad = 2.70;
  double status_rate_Hz = 0.0;  // servo: status frames sent by the drive itself; else 0
  int most_unanswered = 5;      // torque and stiffness are allowed up to this many frames after the last
                                // reply
};

struct Limits {
  std::size_t motor_count = kMotorCount;
  std::array<MotorLimits, kMotorCount> motor{};
  // Share of a 1 Mbit/s bus that the drives' frames may use, with worst-case stuff bits.
  double bus_share = 0.8;
};

}  // namespace sandhopper::transmit
