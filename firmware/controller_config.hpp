#pragma once
#include <array>

#include "config/fields.hpp"
#include "drivers/samples.hpp"
#include "estimation/kalman_filter.hpp"
#include "estimation/leg.hpp"
#include "firmware/state/start_state.hpp"
#include "firmware/supervision/supervision_config.hpp"
#include "terrain/stiffness_fit.hpp"

// Configuration of the cycle: one struct per role.
namespace sandhopper {

struct EstimatorConfig {
  KalmanConfig kalman{};
  double observer_gain_per_s = 400.0;
  double weighting_accel_cutoff_Hz = 60.0;  // low-pass of the foot's acceleration before the weights

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("kalman", self.kalman);
    visit("observer_gain_per_s", self.observer_gain_per_s, Range{1.0, 10000.0});
    visit("weighting_accel_cutoff_Hz", self.weighting_accel_cutoff_Hz, Range{1.0, 400.0});
  }
};

// Virtual spring along the leg, F = K (L0 - L) - B dL/dt, tau = F L' over both motors, and the thresholds of
// the phase changes.
struct ControllerConfig {
  double compression_stiffness_N_per_m = 375.0;
  double extension_stiffness_N_per_m = 500.0;
  double compression_length_m = 0.30;  // neutral length in compression and flight
  double extension_length_m = 0.34;
  double stance_damping_N_s_per_m = 0.0;
  double flight_stiffness_N_per_m = 500.0;
  double flight_damping_N_s_per_m = 15.0;
  double soft_stop_damping_N_s_per_m = 80.0;
  double touchdown_deflection_m = 0.002;
  double touchdown_rate_mps = 0.05;
  double touchdown_height_margin_m = 0.015;  // touchdown is accepted only up to this far above the expected
                                             // ground
  double compression_end_min_deflection_m = 0.004;
  double liftoff_margin_m = 0.0005;

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("compression_stiffness_N_per_m", self.compression_stiffness_N_per_m, Range{10.0, 5000.0});
    visit("extension_stiffness_N_per_m", self.extension_stiffness_N_per_m, Range{10.0, 5000.0});
    visit("compression_length_m", self.compression_length_m, Range{0.02, 2.0});
    visit("extension_length_m", self.extension_length_m, Range{0.02, 2.0});
    visit("stance_damping_N_s_per_m", self.stance_damping_N_s_per_m, Range{0.0, 500.0});
    visit("flight_stiffness_N_per_m", self.flight_stiffness_N_per_m, Range{10.0, 5000.0});
    visit("flight_damping_N_s_per_m", self.flight_damping_N_s_per_m, Range{0.0, 500.0});
    visit("soft_stop_damping_N_s_per_m", self.soft_stop_damping_N_s_per_m, Range{0.0, 500.0});
    visit("touchdown_deflection_m", self.touchdown_deflection_m, Range{1e-4, 0.1});
    visit("touchdown_rate_mps", self.touchdown_rate_mps, Range{1e-3, 5.0});
    visit("touchdown_height_margin_m", self.touchdown_height_margin_m, Range{0.0, 0.2});
    visit("compression_end_min_deflection_m", self.compression_end_min_deflection_m, Range{0.0, 0.1});
    visit("liftoff_margin_m", self.liftoff_margin_m, Range{0.0, 0.05});
  }
};

// From the request to arm until ready: drives on with zero gains; a small torque that each drive's current
// must follow (`drive_confirmation.hpp`); then everything at rest for `window_s`, while both encoders are
// checked against the pose and IMU bias, load-cell tare and height are measured.
struct ArmingConfig {
  double enable_s = 0.03;
  double confirm_torque_Nm = 0.1;
  double confirm_s = 0.02;
  int confirm_tries = 3;
  double window_s = 0.20;
  double zero_pose_length_m = 0.30;  // hip-to-toe length in which the robot hangs when armed
  double zero_tolerance_rad = 0.03;
  double still_range_rad = 0.005;     // largest minus smallest angle in the window
  double free_fall_accel_mps2 = 5.0;  // a smaller specific force of the body means that it was released
  int free_fall_cycles = 3;

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("enable_s", self.enable_s, Range{0.01, 5.0});
    visit("confirm_torque_Nm", self.confirm_torque_Nm, Range{0.01, 5.0});
    visit("confirm_s", self.confirm_s, Range{0.016, 1.0});
    visit("confirm_tries", self.confirm_tries, Range{1, 20});
    visit("window_s", self.window_s, Range{0.02, 10.0});
    visit("zero_pose_length_m", self.zero_pose_length_m, Range{0.02, 2.0});
    visit("zero_tolerance_rad", self.zero_tolerance_rad, Range{1e-3, 0.5});
    visit("still_range_rad", self.still_range_rad, Range{1e-4, 1.0});
    visit("free_fall_accel_mps2", self.free_fall_accel_mps2, Range{0.5, 9.0});
    visit("free_fall_cycles", self.free_fall_cycles, Range{1, 100});
  }
};

struct LimitsConfig {
  double motor_torque_Nm = 2.8;
  double leg_angle_min_rad = 0.15;
  double leg_angle_max_rad = 2.70;
  double motor_speed_radps = 40.0;
  double motor_temperature_C = 90.0;
  double encoder_mismatch_rad = 0.05;
  int motor_reply_misses = 3;  // cycles
  double imu_age_s = 0.010;
  double tof_age_s = 0.100;
  double load_cell_age_s = 0.050;
  double phase_time_s = 2.0;
  int strides = 3;  // then a soft stop
  double settle_s = 0.2;
  double settled_speed_mps = 0.03;
  double ramp_down_s = 1.0;
  double fault_damping_Nm_s_per_rad = 0.3;
  double fault_damp_s = 1.0;
  double fault_hold_stiffness_Nm_per_rad = 15.0;
  double fault_hold_s = 0.5;  // then damp

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("motor_torque_Nm", self.motor_torque_Nm, Range{0.01, 200.0});
    visit("leg_angle_min_rad", self.leg_angle_min_rad, Range{-3.2, 3.2});
    visit("leg_angle_max_rad", self.leg_angle_max_rad, Range{-3.2, 3.2});
    visit("motor_speed_radps", self.motor_speed_radps, Range{0.1, 1000.0});
    visit("motor_temperature_C", self.motor_temperature_C, Range{20.0, 200.0});
    visit("encoder_mismatch_rad", self.encoder_mismatch_rad, Range{1e-3, 1.0});
    visit("motor_reply_misses", self.motor_reply_misses, Range{1, 1000});
    visit("imu_age_s", self.imu_age_s, Range{1e-3, 10.0});
    visit("tof_age_s", self.tof_age_s, Range{1e-3, 10.0});
    visit("load_cell_age_s", self.load_cell_age_s, Range{1e-3, 10.0});
    visit("phase_time_s", self.phase_time_s, Range{0.1, 60.0});
    visit("strides", self.strides, Range{1, 1000000});
    visit("settle_s", self.settle_s, Range{0.01, 10.0});
    visit("settled_speed_mps", self.settled_speed_mps, Range{1e-3, 1.0});
    visit("ramp_down_s", self.ramp_down_s, Range{0.01, 10.0});
    visit("fault_damping_Nm_s_per_rad", self.fault_damping_Nm_s_per_rad, Range{0.0, 5.0});
    visit("fault_damp_s", self.fault_damp_s, Range{0.0, 60.0});
    visit("fault_hold_stiffness_Nm_per_rad", self.fault_hold_stiffness_Nm_per_rad, Range{0.0, 500.0});
    visit("fault_hold_s", self.fault_hold_s, Range{0.0, 60.0});
  }
};

// Everything Controller needs. `torque_constant_Nm_per_A` is each motor's calibrated constant; it stands in
// the motor tables of the robot's file and is copied here.
struct CycleConfig {
  LegParameters robot{};
  std::array<double, kMotorCount> torque_constant_Nm_per_A{0.0868, 0.0868};
  EstimatorConfig estimator{};
  ControllerConfig controller{};
  ArmingConfig arming{};
  StiffnessConfig stiffness{};
  LimitsConfig limits{};
  SupervisionConfig supervision{};
  // Replies per second that a drive must send: one per command, or its configured status rate.
  std::array<double, kMotorCount> motor_reply_rate_Hz{1000.0, 1000.0};
  // True if the drive computes the gains itself. Otherwise the host does, from the newest sample
  // (`kHostLawAge_s`).
  std::array<bool, kMotorCount> law_in_drive{true, true};
  StartState start{};
};

}  // namespace sandhopper
