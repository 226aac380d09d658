#include <algorithm>
#include <cmath>

#include "tools/conceal/hopper/world.hpp"

namespace sandhopper::conceal::hopper {

World draw(Random& random) {
  World w;
  w.bed.stiffness_N_per_m = six_digits(random.uniform(1100.0, 2200.0));
  // Some beds have no added mass, and some beliefs contain none.
  if (random.chance(0.4)) w.bed.added_mass_factor = w.bed.drag_factor = 0.0;
  w.robot.body_kg = six_digits(random.uniform(1.45, 1.75));
  w.robot.rail_coulomb_N = six_digits(random.uniform(1.5, 4.5));
  w.robot.rail_viscous_N_s_per_m = random.chance(0.5) ? 0.0 : six_digits(random.uniform(0.2, 0.8));
  w.sensors.mocap = random.chance(0.35);
  w.sensors.tof_noise_m = six_digits(random.uniform(2e-3, 6e-3));
  w.sensors.load_cell_noise_N = six_digits(random.uniform(0.15, 0.4));
  w.spread.bed_stiffness = six_digits(random.uniform(0.015, 0.03));
  w.spread.tof_bias_m = six_digits(random.uniform(1e-3, 3e-3));
  return w;
}

namespace {

Json robot_keys(const Robot& r) {
  return {{"body_mass_kg", r.body_kg},
          {"foot_mass_kg", r.foot_kg},
          {"upper_link_mass_kg", r.upper_kg},
          {"lower_link_mass_kg", r.lower_kg},
          {"upper_link_length_m", r.upper_m},
          {"lower_link_length_m", r.lower_m},
          {"upper_link_com_m", r.upper_com_m},
          {"lower_link_com_m", r.lower_com_m},
          {"upper_link_inertia_kg_m2", r.upper_kg_m2},
          {"lower_link_inertia_kg_m2", r.lower_kg_m2},
          {"rotor_inertia_kg_m2", r.rotor_kg_m2},
          {"hip_offset_m", r.hip_offset_m},
          {"foot_height_m", r.foot_height_m},
          {"rail_coulomb_N", r.rail_coulomb_N},
          {"rail_viscous_N_s_per_m", r.rail_viscous_N_s_per_m},
          {"joint_coulomb_Nm", r.joint_coulomb_Nm},
          {"cogging_amplitude_Nm", r.cogging_Nm},
          {"cogging_periods_per_rev", r.cogging_per_rev}};
}

Json controller_keys(const Gains& g) {
  return {{"rate_Hz", 1000.0},
          {"compression_length_m", g.compression_length_m},
          {"extension_length_m", g.extension_length_m},
          {"extension_stiffness_N_per_m", g.extension_N_per_m},
          {"stance_damping_N_s_per_m", g.stance_damping_N_s_per_m},
          {"flight_stiffness_N_per_m", g.flight_N_per_m},
          {"flight_damping_N_s_per_m", g.flight_damping_N_s_per_m},
          {"touchdown_deflection_m", g.touchdown_deflection_m},
          {"touchdown_rate_mps", g.touchdown_rate_mps},
          {"compression_end_min_deflection_m", g.switch_deflection_m},
          {"liftoff_margin_m", g.liftoff_margin_m}};
}

Json sensor_keys(const Sensors& s) {
  return {{"imu_rate_Hz", s.imu_rate_Hz},
          {"imu_noise_mps2", s.imu_noise_mps2},
          {"imu_bandwidth_Hz", s.imu_bandwidth_Hz},
          {"tof_rate_Hz", s.tof_rate_Hz},
          {"tof_noise_m", s.tof_noise_m},
          {"tof_latency_s", s.tof_latency_s},
          {"encoder_counts_per_rev", s.encoder_counts},
          {"encoder_noise_rad", s.encoder_noise_rad},
          {"encoder_velocity_bandwidth_Hz", s.encoder_velocity_bandwidth_Hz},
          {"current_noise_A", s.current_noise_A},
          {"load_cell_noise_N", s.load_cell_noise_N},
          {"load_cell_bandwidth_Hz", s.load_cell_bandwidth_Hz},
          {"load_cell_rate_Hz", s.load_cell_rate_Hz},
          {"mocap_rate_Hz", s.mocap_rate_Hz},
          {"mocap_noise_m", s.mocap_noise_m}};
}

Json spread_keys(const Spread& s) {
  return {{"bed_stiffness_relative", s.bed_stiffness},
          {"bed_fluctuation_relative", s.bed_fluctuation},
          {"surface_height_m", s.surface_m},
          {"release_height_m", s.release_m},
          {"load_cell_offset_N", s.load_cell_offset_N},
          {"imu_bias_mps2", s.imu_bias_mps2},
          {"tof_bias_m", s.tof_bias_m},
          {"current_offset_A", s.current_offset_A}};
}

}  // namespace

Belief belief(const World& w) {
  Belief b;
  b.gravity_mps2 = w.gravity_mps2;
  auto robot = robot_keys(w.robot);
  robot["foot_radius_m"] = w.bed.foot_radius_m;
  b.tables.push_back({"robot", robot});
  b.tables.push_back({"motor",
                      {{"torque_constant_Nm_per_A", w.drive.torque_constant_Nm_per_A},
                       {"torque_limit_Nm", w.drive.torque_limit_Nm},
                       {"current_loop_time_constant_s", w.drive.current_lag_s}}});
  b.tables.push_back({"controller", controller_keys(w.gains)});
  b.tables.push_back({"terrain", terrain_keys(w.bed)});
  b.tables.push_back({"sensors", sensor_keys(w.sensors)});
  b.tables.push_back({"spread", spread_keys(w.spread)});
  return b;
}

std::vector<Setup> draw_setups(const World& w, int trials, Random& random) {
  constexpr double kStiffness_N_per_m[] = {250.0, 375.0, 500.0};
  const bool with_sweeps = random.chance(0.5), with_holds = random.chance(0.3),
             with_payload = random.chance(0.3);
  std::vector<Setup> setups;
  for (int i = 0; i < trials; ++i) {
    Setup s;
    const double share = (i % 4 + random.uniform()) / 4.0, session = 1 + i * 2 / trials;
    const bool sweep = with_sweeps && !w.same_drops && i % 6 == 5,
               hold = with_holds && !w.same_drops && i % 6 == 3;
    s.keys["kind"] = sweep ? "air_sweep" : hold ? "hold" : "hop";
    if (sweep) {
      s.keys["sweep_centre_rad"] = 1.1;
      s.keys["sweep_amplitude_rad"] = six_digits(random.uniform(0.3, 0.6));
      s.keys["sweep_frequency_Hz"] = six_digits(random.log_uniform(0.5, 4.0));
      s.keys["body_clamped"] = true;
    } else {
      s.keys["compression_stiffness_N_per_m"] = w.same_drops ? 375.0 : kStiffness_N_per_m[i % 3];
      s.keys["extension_stiffness_N_per_m"] = 500.0;
    }
    // From a large height, or in a second hop, the softest leg would reach its stop.
    const bool soft = !sweep && s.keys["compression_stiffness_N_per_m"] == kStiffness_N_per_m[0];
    if (!sweep && !hold)
      s.keys["release_height_m"] = w.same_drops ? 0.05 : six_digits(0.005 + (soft ? 0.03 : 0.085) * share);
    if (!sweep) {
      s.keys["bed_depth_m"] = six_digits(random.uniform(0.07, 0.12));
      s.keys["wait_s"] = six_digits(random.log_uniform(1.0, 600.0));
      s.keys["pushes_since_preparation"] = i % 2 == 0 ? 0 : random.below(4);
    }
    if (with_payload && i % 4 == 1) s.keys["payload_kg"] = 0.25;
    s.keys["duration_s"] = sweep ? 2.0 : hold ? 0.8 : soft ? 0.65 : 1.3;
    s.keys["session"] = static_cast<int>(session);
    setups.push_back(std::move(s));
  }
  return setups;
}

}  // namespace sandhopper::conceal::hopper
