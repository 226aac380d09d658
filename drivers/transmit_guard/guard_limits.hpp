#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "drivers/samples.hpp"

// Plain numbers, and a namespace of their own: nothing of the motor driver is used here, so that one mistake
// cannot be made twice without being seen.
namespace sandhopper::transmit {

// The protocol of a drive's board: V1/V2 in MIT mode, V1/V2 in servo mode, V3. No two of them have the same
// frames (the maker's AK Series Module Driver User Manual V1.0.18 for the first two, V3.0.1 for the third).
enum class Dialect : std::uint8_t { mit, servo, v3 };

// One drive as it is wired and set, and what it may be told. All limits are those of the link.
struct MotorLimits {
  Dialect dialect = Dialect::mit;
  std::uint32_t can_id = 1;
  std::uint32_t master_id = 0;  // identifier of replies (mit); 0 and can_id are taken, too

  // Full scales of the drive's fields, at its output: position, velocity and torque from -range to +range,
  // gains from 0 to range.
  double position_range_rad = 12.5;
  double velocity_range_radps = 50.0;
  double kp_range_Nm_per_rad = 500.0;
  double kd_range_Nm_s_per_rad = 5.0;
  double torque_range_Nm = 18.0;

  // From the drive's output to the link: angle = zero_offset + sign * position / gear_ratio. The torque at
  // the drive's output is torque_constant * current. A torque field becomes a current by the constant that
  // the drive believes.
  int sign = 1;
  double gear_ratio = 1.0;
  double zero_offset_rad = 0.0;
  double torque_constant_Nm_per_A = 0.0868;
  double drive_torque_constant_Nm_per_A = 0.0868;
  int pole_pairs = 21;
  double drive_reduction = 1.0;

  double torque_Nm = 2.8;        // feed-forward torque, with what the velocity set-point adds to it
  double kp_Nm_per_rad = 15.0;   // stiffness
  double kd_Nm_s_per_rad = 0.3;  // damping
  double speed_radps = 40.0;     // velocity set-point
  double angle_min_rad = 0.15;   // position set-point, while there is stiffness
  double angle_max_rad = 2.70;
  double status_rate_Hz = 0.0;  // servo: status frames sent by the drive itself; else 0
  int most_unanswered = 5;      // frames since the last reply, up to which torque and stiffness may follow
};

struct Limits {
  std::size_t motor_count = kMotorCount;
  std::array<MotorLimits, kMotorCount> motor{};
  // Share of a 1 Mbit/s bus that the drives' frames may take, worst-case stuff bits counted.
  double bus_share = 0.8;
};

}  // namespace sandhopper::transmit
