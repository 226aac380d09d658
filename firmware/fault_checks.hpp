#pragma once
#include <array>

#include "firmware/fault_check.hpp"

// One entry per fault: the quantity that its check compares, and the limit. A test requires an entry for
// every fault.
namespace sandhopper {

inline constexpr std::string_view kEitherWay = "between plus and minus";

namespace channels {

inline constexpr std::string_view kLoad = "load_cell_N estimate_contact_force_N";
inline constexpr std::string_view kReplies = "motor_left_reply_age_s motor_right_reply_age_s";
inline constexpr std::string_view kPositions = "motor_left_position_rad motor_right_position_rad";
inline constexpr std::string_view kSpeeds = "motor_left_velocity_radps motor_right_velocity_radps";
inline constexpr std::string_view kCurrents = "motor_left_current_A motor_right_current_A";
inline constexpr std::string_view kTorques = "command_left_torque_Nm command_right_torque_Nm";
inline constexpr std::string_view kTemperatures = "motor_left_temperature_C motor_right_temperature_C";
inline constexpr std::string_view kVoltages = "motor_left_voltage_V motor_right_voltage_V";
inline constexpr std::string_view kAccels = "imu_body_accel_z_mps2 imu_foot_accel_z_mps2";
inline constexpr std::string_view kHeights = "tof_height_m estimate_body_z_m";
inline constexpr std::string_view kAges = "imu_body_age_s imu_foot_age_s tof_age_s load_cell_age_s";
inline constexpr std::string_view kBus = "bus_errors bus_no_acknowledge bus_send_failures bus_overflows";
inline constexpr std::string_view kDialect = "bus_unsolicited bus_rejected";
inline constexpr std::string_view kTilt = "imu_body_gyro_x_radps imu_body_gyro_y_radps";
inline constexpr std::string_view kLength = "estimate_leg_length_m";
inline constexpr std::string_view kSpeed = "estimate_body_velocity_mps";
inline constexpr std::string_view kFoot = "estimate_foot_z_m";
inline constexpr std::string_view kCycle = "cycle_step_s";

}  // namespace channels

inline constexpr std::array kFaultChecks = [] {
  using enum Fault;
  using D = FaultDevice;
  using namespace channels;
  return std::array{
      FaultCheck{emergency_stop, D::none, 0, "e-stop line open", "", "", "0: closed", "emergency_stop"},
      FaultCheck{motor_reply_lost, D::motor, 1, "cycles in a row without a reply", "",
                 "limits.motor_reply_misses", "fewer than", kReplies},
      FaultCheck{drive_error, D::motor, 1, "error code of the drive", "", "", "0: no error", kCurrents},
      FaultCheck{encoders_disagree, D::none, 0, "left angle less right angle", "rad",
                 "limits.encoder_mismatch_rad", kEitherWay, kPositions},
      FaultCheck{leg_angle_limit, D::motor, 1, "angle of the upper link", "rad",
                 "limits.leg_angle_min_rad|limits.leg_angle_max_rad", "", kPositions, true},
      FaultCheck{motor_speed_limit, D::motor, 1, "speed", "rad/s", "limits.motor_speed_radps", kEitherWay,
                 kSpeeds, true},
      FaultCheck{imu_stale, D::sensor, 1, "age of the newest sample", "s", "limits.imu_age_s", "at most",
                 kAges, true},
      FaultCheck{tof_stale, D::sensor, 1, "age of the newest sample", "s", "limits.tof_age_s", "at most",
                 kAges, true},
      FaultCheck{load_cell_stale, D::sensor, 1, "age of the newest sample", "s", "limits.load_cell_age_s",
                 "at most", kAges, true},
      FaultCheck{estimate_not_finite, D::none, 0, "estimated contact force", "N", "", "a number", kAccels},
      FaultCheck{bus_fault, D::none, 0, "error frames since the cycle before", "", "", "0", kBus},
      FaultCheck{motor_temperature, D::motor, 1, "temperature that the drive reports", "°C",
                 "limits.motor_temperature_C", "at most", kTemperatures, true},
      FaultCheck{phase_timeout, D::none, 0, "time in this phase", "s", "limits.phase_time_s", "at most",
                 kHeights},
      FaultCheck{bus_off, D::none, 0, "controller off the bus", "", "", "0: on the bus", kBus},
      FaultCheck{bus_passive, D::none, 0, "frames without acknowledge since the cycle before", "", "",
                 "0, and the controller not error-passive", kBus},
      FaultCheck{bus_send_refused, D::none, 0, "commands that did not leave in time", "", "", "0", kBus},
      FaultCheck{bus_overflow, D::none, 0, "received frames dropped since the cycle before", "", "", "0",
                 kBus},
      FaultCheck{motor_reply_intermittent, D::motor, 1, "share of the last 50 commands answered", "",
                 "supervision.motor_reply_share", "at least", kReplies},
      FaultCheck{motor_reply_late, D::motor, 1, "age of the state in a reply", "s",
                 "supervision.motor_reply_age_s", "at most", kReplies, true},
      FaultCheck{motor_reply_unexpected, D::motor, 1, "replies without a command (leaking count)", "", "",
                 "fewer than 5", kDialect},
      FaultCheck{motor_reply_foreign, D::motor, 1, "frames of another dialect since the cycle before", "", "",
                 "0", kDialect},
      FaultCheck{motor_position_jump, D::motor, 1, "change of the position between two replies", "rad",
                 "supervision.motor_jump_rad", "the way at limits.motor_speed_radps between them, plus",
                 kPositions, false, "limits.motor_speed_radps", "rad/s"},
      FaultCheck{motor_velocity_implausible, D::motor, 1,
                 "reported velocity less that of the position (low-pass)", "rad/s",
                 "supervision.motor_velocity_error_radps", "a quarter of the speed, plus", kSpeeds},
      FaultCheck{motor_torque_implausible, D::motor, 1, "torque from the current less command (low-pass)",
                 "N m", "supervision.motor_torque_error_Nm", kEitherWay, kCurrents},
      FaultCheck{encoder_stuck, D::motor, 1, "turn of the other side while this one stood still", "rad",
                 "supervision.encoder_stuck_rad", "at most", kPositions},
      FaultCheck{motor_current_limit, D::motor, 1, "current", "A", "supervision.motor_current_A", kEitherWay,
                 kCurrents, true},
      FaultCheck{motor_torque_limit, D::motor, 1, "time at limits.motor_torque_Nm", "s",
                 "supervision.torque_limit_s", "at most", kTorques, false, "limits.motor_torque_Nm", "N m"},
      FaultCheck{motor_winding_hot, D::motor, 1, "winding temperature of the thermal model", "°C",
                 "supervision.winding_temperature_C", "at most", kCurrents},
      FaultCheck{bus_voltage_limit, D::motor, 1, "supply voltage that the drive reports", "V",
                 "supervision.bus_voltage_min_V|supervision.bus_voltage_max_V", "", kVoltages, true},
      FaultCheck{imu_stuck, D::sensor, 1, "equal samples in a row", "", "supervision.stuck_samples",
                 "fewer than", kAccels},
      FaultCheck{imu_out_of_range, D::sensor, 1, "samples at the end of the range", "",
                 "supervision.range_samples", "fewer than", kAccels},
      FaultCheck{imu_implausible, D::imu_pair, 1, "body less foot less encoders, over 20 ms", "m/s",
                 "supervision.imu_disagreement_mps", kEitherWay, kAccels},
      FaultCheck{tilt_limit, D::none, 0, "tilt of the body", "rad", "supervision.tilt_rad", "at most", kTilt},
      FaultCheck{tof_stuck, D::sensor, 1, "equal readings in a row", "", "supervision.stuck_samples",
                 "fewer than", kHeights},
      FaultCheck{tof_out_of_range, D::sensor, 1, "readings without a measurement", "",
                 "supervision.range_samples", "fewer than", kHeights},
      FaultCheck{tof_implausible, D::none, 0, "jump of the height", "m", "supervision.tof_jump_m",
                 "the way at 3 m/s since the last reading, plus", kHeights, false, "", "", true},
      FaultCheck{load_cell_stuck, D::sensor, 1, "equal samples in a row", "", "supervision.stuck_samples",
                 "fewer than", kLoad},
      FaultCheck{load_cell_out_of_range, D::sensor, 1, "samples out of range (leaking count)", "",
                 "supervision.range_samples", "less than half of", kLoad},
      FaultCheck{load_cell_implausible, D::none, 0, "load cell less momentum observer (low-pass)", "N",
                 "supervision.load_cell_error_N", "half of the force, plus", kLoad, false, "", "", true},
      FaultCheck{sensor_intermittent, D::sensor, 1, "samples in a second", "Hz", "supervision.imu_rate_Hz",
                 "at least", kAges},
      FaultCheck{sample_time_invalid, D::sensor, 1, "time stamp less the one before", "s", "",
                 "above 0, and the stamp at most 5 ms in the future", kAges},
      FaultCheck{leg_length_limit, D::none, 0, "leg length", "m",
                 "supervision.leg_length_min_m|supervision.leg_length_max_m", "", kLength, true},
      FaultCheck{body_speed_limit, D::none, 0, "speed of the body", "m/s", "supervision.body_speed_mps",
                 kEitherWay, kSpeed, true},
      FaultCheck{body_height_limit, D::none, 0, "height of the foot over the sand", "m",
                 "supervision.foot_height_m", "at most", kFoot, true},
      FaultCheck{energy_implausible, D::none, 0, "energy gained in this flight", "J",
                 "supervision.energy_gain_J", "at most", kHeights},
      FaultCheck{hop_count_limit, D::none, 0, "touchdowns since the start", "", "supervision.hop_count",
                 "at most", kHeights},
      FaultCheck{cycle_gap, D::none, 0, "grid points missed in a row", "", "supervision.cycle_gap", "at most",
                 kCycle},
      FaultCheck{cycle_overruns, D::none, 0, "overruns within a second", "", "supervision.overruns_per_s",
                 "at most", kCycle},
      FaultCheck{watchdog_tripped, D::none, 0, "time that the cycle stood still", "s",
                 "watchdog.cycle_stall_s", "less than", kCycle},
      FaultCheck{estimate_diverged, D::none, 1, "time-of-flight readings refused in a row", "", "",
                 "fewer than 20, each beyond estimator.kalman.tof_gate_sigma", kHeights, false,
                 "estimator.kalman.tof_gate_sigma", "standard deviations"},
      FaultCheck{transmit_refused, D::none, 0, "number of the rule that the frame broke", "", "",
                 "0: none (drivers/transmit_guard/rule.hpp)", kTorques},
  };
}();

}  // namespace sandhopper
