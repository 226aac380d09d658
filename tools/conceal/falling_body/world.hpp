#pragma once
#include <map>
#include <string>

#include "tools/conceal/core/channel_faults.hpp"
#include "tools/conceal/core/plant_of.hpp"

// A body that falls through a fluid, with or without a soft floor. Believed:
//
//   (m + C_m rho V) h'' = -m g + B rho V g - 1/2 rho A C_d |h'| h' - b h' + k max(0, surface - h)
//
// The last term acts while falling only.
namespace sandhopper::conceal::falling_body {

struct World {
  double gravity_mps2 = 9.81;
  double mass_kg = 1.0, frontal_area_m2 = 0.01, volume_m3 = 1e-3;
  double density_kg_per_m3 = 1.2, drag_coefficient = 0.0, linear_drag_N_s_per_m = 0.0;
  double buoyancy_factor = 0.0, added_mass_factor = 0.0;
  bool has_bed = false;
  double surface_height_m = 0.0, bed_stiffness_N_per_m = 0.0;
  // Range of the release height.
  double least_release_m = 1.0, most_release_m = 10.0;

  bool has_height = true, has_accel = true;
  double row_rate_Hz = 500.0, height_rate_Hz = 100.0;
  double height_noise_m = 2e-3, accel_noise_mps2 = 0.03;
  double release_height_spread_m = 5e-3, release_speed_spread_mps = 0.01, accel_bias_spread_mps2 = 0.02;
  double bed_stiffness_spread = 0.03;

  struct Hidden {
    double quadratic = 0.0, linear_N_s_per_m = 0.0;  // quadratic: N s2/m2
    double buoyancy = 0.0, added_mass = 0.0, mass_share = 0.0;
    double gust_N = 0.0, gust_at_m = 0.0, gust_width_m = 0.3;
    double tether_N_per_m = 0.0, tether_slack_m = 0.0;  // Pulls up after a fall of this length.
    double flutter_N = 0.0, flutter_Hz_per_mps = 1.0;   // vortex shedding
    double opening_N_s2 = 0.0, opening_at_s = 0.0;      // Drag that starts at this time.
  } hidden;
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

std::vector<Recipe<World>> fluid_effects();
std::vector<Recipe<World>> sensor_effects();
std::vector<Recipe<World>> unlisted_effects();
std::vector<Restriction<World>> restrictions();

}  // namespace sandhopper::conceal::falling_body
