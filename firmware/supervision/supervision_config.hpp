#pragma once
#include "config/fields.hpp"

namespace sandhopper {

// Limits of the supervisor, in addition to those in [limits]. Numbers of samples count fresh samples.
struct SupervisionConfig {
  double startup_s = 0.5;  // time from the first cycle within which a device must deliver its first sample
  // Motors.
  double motor_reply_share = 0.6;     // least share of the last 50 commands that must be answered
  double motor_reply_age_s = 0.0016;  // a reply is in time if its state is no older than this
  double motor_jump_rad = 0.015;      // tolerance in addition to the travel at motor_speed_radps between two
                                      // replies
  double motor_velocity_error_radps = 2.0;
  double motor_torque_error_Nm = 0.5;
  double motor_current_A = 45.0;
  double torque_limit_s = 0.3;      // longer than a stance
  double encoder_stuck_rad = 0.03;  // travel of the other side
  double bus_voltage_min_V = 18.0;
  double bus_voltage_max_V = 56.0;
  // Thermal model of a motor, see thermal_model.hpp.
  double winding_temperature_C = 110.0;
  double phase_resistance_Ohm = 0.0625;
  double winding_capacity_J_per_K = 40.0;
  double winding_resistance_K_per_W = 1.0;
  double housing_capacity_J_per_K = 200.0;
  double housing_resistance_K_per_W = 2.0;
  double ambient_C = 25.0;
  // Sensors.
  int stuck_samples = 20;
  int range_samples = 10;
  double imu_range_mps2 = 152.0;
  double imu_gyro_radps = 8.0;
  double imu_disagreement_mps = 0.35;  // difference between both IMUs and the encoders over 20 ms
  double imu_rate_Hz = 800.0;          // least number of cycles per second with a new sample; fewer are a
                                       // fault
  double tilt_rad = 0.2;
  double tof_range_m = 2.5;
  double tof_jump_m = 0.06;
  double tof_rate_Hz = 300.0;
  double load_cell_range_N = 250.0;
  double load_cell_error_N = 60.0;
  double load_cell_rate_Hz = 600.0;
  // The robot as a whole.
  double leg_length_min_m = 0.125;
  double leg_length_max_m = 0.3595;
  double body_speed_mps = 3.5;
  double foot_height_m = 0.25;
  double energy_gain_J = 2.0;  // gain within one flight
  int hop_count = 100000;
  // The cycle.
  int cycle_gap = 20;
  int overruns_per_s = 50;

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("startup_s", self.startup_s, Range{0.01, 60.0});
    visit("motor_reply_share", self.motor_reply_share, Range{0.0, 1.0});
    visit("motor_reply_age_s", self.motor_reply_age_s, Range{0.001, 0.1});
    visit("motor_jump_rad", self.motor_jump_rad, Range{1e-3, 1.0});
    visit("motor_velocity_error_radps", self.motor_velocity_error_radps, Range{0.1, 100.0});
    visit("motor_torque_error_Nm", self.motor_torque_error_Nm, Range{0.01, 100.0});
    visit("motor_current_A", self.motor_current_A, Range{0.1, 1000.0});
    visit("torque_limit_s", self.torque_limit_s, Range{0.001, 60.0});
    visit("encoder_stuck_rad", self.encoder_stuck_rad, Range{1e-3, 1.0});
    visit("bus_voltage_min_V", self.bus_voltage_min_V, Range{0.0, 100.0});
    visit("bus_voltage_max_V", self.bus_voltage_max_V, Range{1.0, 100.0});
    visit("winding_temperature_C", self.winding_temperature_C, Range{20.0, 250.0});
    visit("phase_resistance_Ohm", self.phase_resistance_Ohm, Range{1e-3, 10.0});
    visit("winding_capacity_J_per_K", self.winding_capacity_J_per_K, Range{0.1, 10000.0});
    visit("winding_resistance_K_per_W", self.winding_resistance_K_per_W, Range{0.01, 100.0});
    visit("housing_capacity_J_per_K", self.housing_capacity_J_per_K, Range{1.0, 100000.0});
    visit("housing_resistance_K_per_W", self.housing_resistance_K_per_W, Range{0.01, 100.0});
    visit("ambient_C", self.ambient_C, Range{-40.0, 80.0});
    visit("stuck_samples", self.stuck_samples, Range{2, 100000});
    visit("range_samples", self.range_samples, Range{1, 100000});
    visit("imu_range_mps2", self.imu_range_mps2, Range{10.0, 400.0});
    visit("imu_gyro_radps", self.imu_gyro_radps, Range{0.1, 100.0});
    visit("imu_disagreement_mps", self.imu_disagreement_mps, Range{0.01, 10.0});
    visit("imu_rate_Hz", self.imu_rate_Hz, Range{0.0, 1000.0});
    visit("tilt_rad", self.tilt_rad, Range{0.01, 1.6});
    visit("tof_range_m", self.tof_range_m, Range{0.05, 30.0});
    visit("tof_jump_m", self.tof_jump_m, Range{1e-3, 10.0});
    visit("tof_rate_Hz", self.tof_rate_Hz, Range{0.0, 1000.0});
    visit("load_cell_range_N", self.load_cell_range_N, Range{1.0, 10000.0});
    visit("load_cell_error_N", self.load_cell_error_N, Range{0.1, 10000.0});
    visit("load_cell_rate_Hz", self.load_cell_rate_Hz, Range{0.0, 1000.0});
    visit("leg_length_min_m", self.leg_length_min_m, Range{0.0, 2.0});
    visit("leg_length_max_m", self.leg_length_max_m, Range{0.0, 2.0});
    visit("body_speed_mps", self.body_speed_mps, Range{0.1, 50.0});
    visit("foot_height_m", self.foot_height_m, Range{0.001, 10.0});
    visit("energy_gain_J", self.energy_gain_J, Range{0.01, 1000.0});
    visit("hop_count", self.hop_count, Range{1, 1000000000});
    visit("cycle_gap", self.cycle_gap, Range{1, 10000});
    visit("overruns_per_s", self.overruns_per_s, Range{1, 1000});
  }
};

}  // namespace sandhopper
