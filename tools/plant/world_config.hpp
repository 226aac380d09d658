#pragma once
#include <string>

#include "config/fields.hpp"
#include "estimation/leg.hpp"
#include "terrain/bed.hpp"
#include "terrain/bed_family.hpp"

// Configuration of the simulated world: the tables and keys of a campaign's nominal.toml, with the default
// robot, bed, sensors and spread. All defaults together form that default set; zero means "no such effect".
namespace sandhopper {

// [robot]: leg values per link and per rotor; joint friction and cogging per motor, on the link's side.
struct WorldRobotConfig {
  LegParameters leg{};
  double rail_coulomb_N = 4.0;
  double rail_viscous_N_s_per_m = 0.0;
  double joint_coulomb_Nm = 0.015;
  // v_s of the dry friction c tanh(v / v_s). The defaults are assumed, not measured. A diagnosis counts the
  // difference from ten times smaller speeds as model error. Below the sharpest speeds the plant's steps of
  // 0.1 ms do not resolve the change of sign: 4 N on 1.2 kg take off 1 mm/s in 0.3 ms.
  static constexpr double kSharpestRail_mps = 1e-3, kSharpestJoint_radps = 0.02;
  double rail_friction_switch_speed_mps = 0.01;
  double joint_friction_switch_speed_radps = 0.2;
  double cogging_amplitude_Nm = 0.02;
  double cogging_periods_per_rev = 252.0;
  double series_compliance_m_per_N = 0.0;  // between toe and foot
  double series_damping_ratio = 0.1;       // damping ratio of the foot on that spring
  double joint_play_rad = 0.0;             // between rotors and links
  double joint_give_relative = 0.3;        // of the play: angle by which 1 N m turns teeth in contact

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    LegParameters::fields(self.leg, visit);
    visit("rail_coulomb_N", self.rail_coulomb_N, Range{0.0, 100.0});
    visit("rail_viscous_N_s_per_m", self.rail_viscous_N_s_per_m, Range{0.0, 1000.0});
    visit("joint_coulomb_Nm", self.joint_coulomb_Nm, Range{0.0, 5.0});
    visit("rail_friction_switch_speed_mps", self.rail_friction_switch_speed_mps,
          Range{kSharpestRail_mps, 1.0});
    visit("joint_friction_switch_speed_radps", self.joint_friction_switch_speed_radps,
          Range{kSharpestJoint_radps, 20.0});
    visit("cogging_amplitude_Nm", self.cogging_amplitude_Nm, Range{0.0, 5.0});
    visit("cogging_periods_per_rev", self.cogging_periods_per_rev, Range{0.0, 10000.0});
    visit("series_compliance_m_per_N", self.series_compliance_m_per_N, Range{0.0, 1e-3});
    visit("series_damping_ratio", self.series_damping_ratio, Range{0.0, 2.0});
    visit("joint_play_rad", self.joint_play_rad, Range{0.0, 0.2});
    visit("joint_give_relative", self.joint_give_relative, Range{0.01, 10.0});
  }
};

// [motor]: each drive, on the link's side. 0.0868 = 60/(2 pi 110 rpm/V) for the KV110; the
// amplitude-invariant convention would give 0.0752.
struct WorldMotorConfig {
  double torque_constant_Nm_per_A = 0.0868;
  double torque_limit_Nm = 2.8;
  double current_loop_time_constant_s = 0.0005;

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("torque_constant_Nm_per_A", self.torque_constant_Nm_per_A, Range{1e-3, 50.0});
    visit("torque_limit_Nm", self.torque_limit_Nm, Range{0.0, 200.0});
    visit("current_loop_time_constant_s", self.current_loop_time_constant_s, Range{0.0, 0.1});
  }
};

// [controller]: the nominal 1 kHz law. The compression stiffness is part of a trial's set-up.
struct NominalControllerConfig {
  double rate_Hz = 1000.0;
  double compression_length_m = 0.30;
  double extension_length_m = 0.34;
  double extension_stiffness_N_per_m = 500.0;
  double stance_damping_N_s_per_m = 0.0;
  double flight_stiffness_N_per_m = 500.0;
  double flight_damping_N_s_per_m = 15.0;
  double touchdown_deflection_m = 0.002;
  double touchdown_rate_mps = 0.05;
  double compression_end_min_deflection_m = 0.004;
  double liftoff_margin_m = 0.0005;

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("rate_Hz", self.rate_Hz, Range{10.0, 10000.0});
    visit("compression_length_m", self.compression_length_m, Range{0.01, 2.0});
    visit("extension_length_m", self.extension_length_m, Range{0.01, 2.0});
    visit("extension_stiffness_N_per_m", self.extension_stiffness_N_per_m, Range{0.0, 1e5});
    visit("stance_damping_N_s_per_m", self.stance_damping_N_s_per_m, Range{0.0, 1e4});
    visit("flight_stiffness_N_per_m", self.flight_stiffness_N_per_m, Range{0.0, 1e5});
    visit("flight_damping_N_s_per_m", self.flight_damping_N_s_per_m, Range{0.0, 1e4});
    visit("touchdown_deflection_m", self.touchdown_deflection_m, Range{0.0, 0.1});
    visit("touchdown_rate_mps", self.touchdown_rate_mps, Range{0.0, 10.0});
    visit("compression_end_min_deflection_m", self.compression_end_min_deflection_m, Range{0.0, 0.1});
    visit("liftoff_margin_m", self.liftoff_margin_m, Range{0.0, 0.1});
  }
};

// [sensors]: properties that are equal in every trial. Rates are nominal, noise is the rms of one sample,
// bandwidths are first-order low-passes. The IMU's structure noise is added only in stance.
struct SensorConfig {
  double imu_rate_Hz = 1666.0;
  double imu_bandwidth_Hz = 400.0;
  double imu_noise_mps2 = 0.012;  // 60 ug/rtHz over the bandwidth
  double imu_structure_noise_mps2 = 0.3;
  double imu_resolution_mps2 = 4.785645e-3;  // 0.488 mg
  double imu_range_mps2 = 156.9064;          // 16 g
  double imu_gyro_noise_radps = 0.0017;      // 5 mdps/rtHz over the bandwidth
  double tof_rate_Hz = 500.0;
  double tof_noise_m = 0.005;
  double tof_latency_s = 0.002;
  double encoder_counts_per_rev = 16384.0;
  double encoder_noise_rad = 1.5e-4;
  double encoder_velocity_bandwidth_Hz = 120.0;
  double current_noise_A = 0.10;
  double load_cell_rate_Hz = 860.0;
  double load_cell_bandwidth_Hz = 300.0;
  double load_cell_noise_N = 0.3;
  double mocap_rate_Hz = 240.0;
  double mocap_noise_m = 0.0002;

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("imu_rate_Hz", self.imu_rate_Hz, Range{1.0, 9000.0});
    visit("imu_bandwidth_Hz", self.imu_bandwidth_Hz, Range{1.0, 5000.0});
    visit("imu_noise_mps2", self.imu_noise_mps2, Range{0.0, 10.0});
    visit("imu_structure_noise_mps2", self.imu_structure_noise_mps2, Range{0.0, 100.0});
    visit("imu_resolution_mps2", self.imu_resolution_mps2, Range{0.0, 10.0});
    visit("imu_range_mps2", self.imu_range_mps2, Range{1.0, 10000.0});
    visit("imu_gyro_noise_radps", self.imu_gyro_noise_radps, Range{0.0, 10.0});
    visit("tof_rate_Hz", self.tof_rate_Hz, Range{1.0, 3000.0});
    visit("tof_noise_m", self.tof_noise_m, Range{0.0, 1.0});
    visit("tof_latency_s", self.tof_latency_s, Range{0.0, 0.1});
    visit("encoder_counts_per_rev", self.encoder_counts_per_rev, Range{0.0, 1e8});
    visit("encoder_noise_rad", self.encoder_noise_rad, Range{0.0, 0.1});
    visit("encoder_velocity_bandwidth_Hz", self.encoder_velocity_bandwidth_Hz, Range{1.0, 5000.0});
    visit("current_noise_A", self.current_noise_A, Range{0.0, 10.0});
    visit("load_cell_rate_Hz", self.load_cell_rate_Hz, Range{1.0, 9000.0});
    visit("load_cell_bandwidth_Hz", self.load_cell_bandwidth_Hz, Range{1.0, 5000.0});
    visit("load_cell_noise_N", self.load_cell_noise_N, Range{0.0, 100.0});
    visit("mocap_rate_Hz", self.mocap_rate_Hz, Range{1.0, 9000.0});
    visit("mocap_noise_m", self.mocap_noise_m, Range{0.0, 0.1});
  }
};

// [spread]: one sigma between trials. `imu_raw_offset` exists from power-on, so the zero at arming removes
// it. `imu_bias` begins with the release, so the zero cannot remove it.
struct SpreadConfig {
  double bed_stiffness_relative = 0.03;
  double bed_fluctuation_relative = 0.02;
  double bed_fluctuation_length_m = 0.002;
  double surface_height_m = 0.0;
  double release_height_m = 0.0;
  double release_speed_mps = 0.0;
  double imu_raw_offset_mps2 = 0.2;  // 40 mg as two sigma
  double imu_bias_mps2 = 0.05;
  double imu_scale_relative = 0.005;
  double imu_clock_relative = 0.01;
  double imu_gyro_bias_radps = 0.01;
  double tof_bias_m = 0.003;
  double tof_clock_relative = 0.001;
  double torque_constant_relative = 0.02;
  double current_offset_A = 0.03;
  double load_cell_offset_N = 0.0;
  double load_cell_clock_relative = 0.03;
  double cable_force_N = 0.0;

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("bed_stiffness_relative", self.bed_stiffness_relative, Range{0.0, 0.3});
    visit("bed_fluctuation_relative", self.bed_fluctuation_relative, Range{0.0, 0.3});
    visit("bed_fluctuation_length_m", self.bed_fluctuation_length_m, Range{1e-4, 0.1});
    visit("surface_height_m", self.surface_height_m, Range{0.0, 0.1});
    visit("release_height_m", self.release_height_m, Range{0.0, 0.1});
    visit("release_speed_mps", self.release_speed_mps, Range{0.0, 1.0});
    visit("imu_raw_offset_mps2", self.imu_raw_offset_mps2, Range{0.0, 10.0});
    visit("imu_bias_mps2", self.imu_bias_mps2, Range{0.0, 10.0});
    visit("imu_scale_relative", self.imu_scale_relative, Range{0.0, 0.2});
    visit("imu_clock_relative", self.imu_clock_relative, Range{0.0, 0.05});
    visit("imu_gyro_bias_radps", self.imu_gyro_bias_radps, Range{0.0, 1.0});
    visit("tof_bias_m", self.tof_bias_m, Range{0.0, 0.1});
    visit("tof_clock_relative", self.tof_clock_relative, Range{0.0, 0.05});
    visit("torque_constant_relative", self.torque_constant_relative, Range{0.0, 0.2});
    visit("current_offset_A", self.current_offset_A, Range{0.0, 5.0});
    visit("load_cell_offset_N", self.load_cell_offset_N, Range{0.0, 100.0});
    visit("load_cell_clock_relative", self.load_cell_clock_relative, Range{0.0, 0.05});
    visit("cable_force_N", self.cable_force_N, Range{0.0, 50.0});
  }
};

struct WorldConfig {
  double gravity_mps2 = kGravity_mps2;
  WorldRobotConfig robot{};
  WorldMotorConfig motor{};
  NominalControllerConfig controller{};
  BedParameters terrain{};
  BedFamilyParameters bed_family{};
  SensorConfig sensors{};
  SpreadConfig spread{};

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("gravity_mps2", self.gravity_mps2, Range{0.0, 30.0});
    visit("robot", self.robot);
    visit("motor", self.motor);
    visit("controller", self.controller);
    visit("terrain", self.terrain);
    visit("bed_family", self.bed_family);
    visit("sensors", self.sensors);
    visit("spread", self.spread);
  }

  // Rules between keys: the leg must not lock and must reach the configured lengths; the bed must not return
  // more work than it received.
  template <class Report>
  void check(Report&& report) const {
    const auto& leg = robot.leg;
    const auto got = [](double value_m) { return ", got " + std::to_string(value_m); };
    const double lock_m = leg.upper_link_length_m + leg.hip_offset_m;
    const double reach_m = leg.upper_link_length_m + leg.lower_link_length_m;
    if (leg.lower_link_length_m <= lock_m)
      report("robot.lower_link_length_m",
             "expected more than upper_link_length_m + hip_offset_m, or the leg locks" +
                 got(leg.lower_link_length_m));
    if (controller.compression_length_m >= reach_m)
      report("controller.compression_length_m",
             "expected less than both links' lengths together" + got(controller.compression_length_m));
    if (controller.extension_length_m >= reach_m)
      report("controller.extension_length_m",
             "expected less than both links' lengths together" + got(controller.extension_length_m));
    check_bed(report);
  }

 private:
  template <class Report>
  void check_bed(Report&& report) const {
    if (bed_family.family == BedFamily::line && bed_family.floor_depth_m == 0.0) return;
    constexpr double kDeepest_m = 0.1;
    const Bed bed(terrain, robot.leg.foot_radius_m, {}, bed_family);
    const double steepest = bed.greatest_stiffness_N_per_m(kDeepest_m);
    const double unloading = bed.unloading_line_N_per_m();
    if (steepest > unloading)
      report("bed_family.unloading_stiffness_factor",
             "expected an unloading line steeper than the bed's curve, which rises by " +
                 std::to_string(steepest) + " N/m where it is steepest; raise this or " +
                 "terrain.unloading_stiffness_ratio; got a line of " + std::to_string(unloading) + " N/m");
  }
};

}  // namespace sandhopper
