#pragma once
#include <map>
#include <string>

#include "tools/conceal/bed/bed.hpp"
#include "tools/conceal/core/channel_faults.hpp"
#include "tools/conceal/core/plant_of.hpp"

// Parameters of the hopper: believed ones of robot, controller and sensors, then the hidden effects (off by
// default).
namespace sandhopper::conceal::hopper {

struct Robot {
  double body_kg = 1.60, foot_kg = 0.55, upper_kg = 0.05, lower_kg = 0.04;
  double upper_m = 0.12, lower_m = 0.24, upper_com_m = 0.06, lower_com_m = 0.12;
  double upper_kg_m2 = 6.0e-5, lower_kg_m2 = 1.92e-4, rotor_kg_m2 = 2.0e-4;
  double hip_offset_m = 0.0, foot_height_m = 0.12;
  double rail_coulomb_N = 4.0, rail_viscous_N_s_per_m = 0.0;
  double joint_coulomb_Nm = 0.015, cogging_Nm = 0.02, cogging_per_rev = 252.0;
};

// `current_lag_s`: time constant of the current loop.
struct Drive {
  double torque_constant_Nm_per_A = 0.0868, torque_limit_Nm = 2.8, current_lag_s = 5e-4;
};

// Parameters of the controller; phases as in tools/conceal/hopper/controller.cpp.
struct Gains {
  double compression_length_m = 0.30, extension_length_m = 0.34;
  double extension_N_per_m = 500.0, stance_damping_N_s_per_m = 0.0;
  double flight_N_per_m = 500.0, flight_damping_N_s_per_m = 15.0;
  double touchdown_deflection_m = 2e-3, touchdown_rate_mps = 0.05, switch_deflection_m = 4e-3,
         liftoff_margin_m = 5e-4;
};

// Rates, bandwidths, latencies and noise (standard deviation of one sample).
struct Sensors {
  bool ideal = false;  // No noise, no quantisation, no scatter, for comparison with a reference.
  double imu_rate_Hz = 1667.0, imu_noise_mps2 = 0.012, imu_bandwidth_Hz = 400.0,
         imu_structure_noise_mps2 = 0.3;
  double tof_rate_Hz = 500.0, tof_noise_m = 5e-3, tof_latency_s = 2e-3;
  double encoder_counts = 16384.0, encoder_noise_rad = 1.5e-4, encoder_velocity_bandwidth_Hz = 120.0;
  double current_noise_A = 0.1, load_cell_noise_N = 0.3, load_cell_bandwidth_Hz = 300.0,
         load_cell_rate_Hz = 860.0;
  bool mocap = false;
  double mocap_rate_Hz = 240.0, mocap_noise_m = 2e-4;
};

// Standard deviations between trials.
struct Spread {
  double bed_stiffness = 0.03, bed_fluctuation = 0.02, surface_m = 5e-4, release_m = 5e-4;
  double load_cell_offset_N = 0.05, imu_bias_mps2 = 0.05, tof_bias_m = 3e-3, current_offset_A = 0.03;
};

// Parameters of the hidden effects; all effects are off by default.
struct Hidden {
  double rail_coulomb_N = 0.0, rail_viscous_N_s_per_m = 0.0, stribeck_N = 0.0, stribeck_mps = 0.03;
  double rail_per_load = 0.0, rail_tilt_rad = 0.0;
  double cable_N_per_m = 0.0, cable_N = 0.0,
         cable_slack_m = 0.01;  // Spring with its zero at the release, and its hysteresis.
  double bump_N = 0.0, bump_at_m = 0.4, bump_width_m = 0.01;  // friction at one height of the rail
  double joint_coulomb_Nm = 0.0, joint_viscous_Nm_s = 0.0;
  double cogging_Nm = 0.0, cogging_per_rev = 42.0, cogging_phase_rad = 0.0;
  double magnet_Nm = 0.0, magnet_at_rad = 1.2, magnet_width_rad = 0.08;
  double spring_Nm_per_rad = 0.0, spring_yield_rad = 0.2;  // elastoplastic, at the joint
  double backlash_rad = 0.0, series_N_per_m = 0.0;
  double torque_constant = 0.0, saturation = 0.0, derating_per_K = 0.0, supply_V = 0.0, delay_s = 0.0;
  double hum_Nm = 0.0, hum_Hz = 37.0;
  double body_kg = 0.0, foot_kg = 0.0, upper_kg = 0.0, lower_kg = 0.0, rotor_kg_m2 = 0.0;
  double upper_m = 0.0, lower_m = 0.0;
  double compression_gain = 0.0, extension_gain = 0.0, switch_late_m = 0.0;
  double encoder_offset_rad = 0.0, eccentricity_rad = 0.0, eccentricity_phase_rad = 0.0;
  double load_cell_kg = 0.0;
};

inline constexpr double kCycle_s = 1e-3;  // Cycle of the controller and of the recording.

struct World {
  double gravity_mps2 = 9.81;
  Robot robot;
  Drive drive;
  Gains gains;
  Bed bed;
  Sensors sensors;
  Spread spread;
  Hidden hidden;
  bool same_drops = false;  // For an ambiguous campaign: one release height, one stiffness.
  std::map<std::string, ChannelFaults> faults;

  ChannelFaults faults_of(const std::string& channel) const {
    const auto found = faults.find(channel);
    return found == faults.end() ? ChannelFaults{} : found->second;
  }
};

// Draws an apparatus, its belief, the set-ups of a campaign, and one recording.
World draw(Random& random);
Belief belief(const World& world);
std::vector<Setup> draw_setups(const World& world, int trials, Random& random);
Table record(const World& world, const Setup& setup, const TrialRandom& trial);
// Phase of the motion in each row of a recording (README.md).
std::vector<std::string> phases(const World& world, const Setup& setup, const TrialRandom& trial,
                                const Table& recorded);

std::vector<Recipe<World>> rail_effects();
std::vector<Recipe<World>> joint_effects();
std::vector<Recipe<World>> drive_effects();
std::vector<Recipe<World>> mass_effects();
std::vector<Recipe<World>> sensor_effects();
std::vector<Recipe<World>> unlisted_effects();
std::vector<Restriction<World>> restrictions();

}  // namespace sandhopper::conceal::hopper
