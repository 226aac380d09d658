#pragma once
#include <map>
#include <string>

#include "tools/conceal/core/channel_faults.hpp"
#include "tools/conceal/core/plant_of.hpp"

// Parameters of a motor axis with an unbalanced arm, on the output side. Believed part:
//
//   J th'' = torque - G sin th - b th' - c tanh(th'/v_s)
//
// The hidden effects are zero by default.
namespace sandhopper::conceal::rotary_axis {

struct World {
  double gravity_mps2 = 9.81;
  double inertia_kg_m2 = 0.1;
  double gravity_torque_Nm = 2.4;
  double viscous_Nm_s = 0.0;
  double coulomb_Nm = 0.0;
  double friction_switch_speed_radps = 0.02;
  double gear_ratio = 6.0;

  double row_rate_Hz = 500.0;
  double duration_s = 6.0;
  double position_range_rad = 12.5, velocity_range_radps = 45.0, torque_range_Nm = 18.0;
  int position_bits = 16, velocity_bits = 12, torque_bits = 12;
  double position_noise_rad = 2e-4, velocity_noise_radps = 0.03, torque_noise_Nm = 0.02;
  double velocity_bandwidth_Hz = 120.0;
  bool bench_load_cell = false;
  double initial_position_spread_rad = 0.01, torque_offset_spread_Nm = 0.01;
  bool only_held = false, only_free_swing = false;  // for ambiguous campaigns

  struct Hidden {
    double coulomb_Nm = 0.0, coulomb_width_radps = 0.015;
    double viscous_Nm_s = 0.0;
    double stribeck_Nm = 0.0, stribeck_speed_radps = 0.2;
    double load_dependent = 0.0;  // friction torque / transmitted torque
    double inertia_share = 0.0, gravity_share = 0.0;
    double offset_rad = 0.0;    // angle of the arm's true bottom
    double torque_scale = 0.0;  // true torque = (1 + this) reported torque
    double saturation = 0.0, saturation_torque_Nm = 10.0;
    double delay_s = 0.0;  // Delay from reported to acting torque.
    double cogging_Nm = 0.0, cogging_per_rev = 84.0, cogging_phase_rad = 0.0;
    double magnet_Nm = 0.0, magnet_at_rad = 0.0, magnet_width_rad = 0.1;
    double rub_Nm = 0.0, rub_from_rad = 0.0, rub_to_rad = 0.0;
    double brake_Nm = 0.0, brake_speed_radps = 1.0;  // Eddy-current brake: largest torque at that speed.
    double spring_Nm_per_rad = 0.0, spring_yield_rad = 0.1;  // Elastoplastic spring: a hysteresis loop.
  } hidden;
  double eccentricity_rad = 0.0, eccentricity_phase_rad = 0.0;
  std::map<std::string, ChannelFaults> faults;  // by channel

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

std::vector<Recipe<World>> friction_effects();
std::vector<Recipe<World>> load_effects();
std::vector<Recipe<World>> drive_effects();
std::vector<Recipe<World>> sensor_effects();
std::vector<Recipe<World>> unlisted_effects();
std::vector<Restriction<World>> restrictions();

}  // namespace sandhopper::conceal::rotary_axis
