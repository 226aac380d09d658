#pragma once
#include <map>
#include <string>

#include "tools/conceal/bed/bed.hpp"
#include "tools/conceal/core/channel_faults.hpp"
#include "tools/conceal/core/plant_of.hpp"

// Parameters of a plate on a linear actuator that is pushed into the bed with a prescribed motion.
namespace sandhopper::conceal::intruder {

struct World {
  double gravity_mps2 = 9.81;
  Bed bed;
  double bed_stiffness_spread = 0.03, bed_fluctuation = 0.02, surface_height_spread_m = 3e-4;
  double load_cell_offset_spread_N = 0.05;

  double row_rate_Hz = 1000.0, load_cell_rate_Hz = 860.0, load_cell_bandwidth_Hz = 300.0,
         load_cell_noise_N = 0.3;
  double position_noise_m = 2e-5, velocity_noise_mps = 2e-3, accel_noise_mps2 = 0.1;
  double fastest_mps = 0.8, deepest_m = 0.045;
  bool only_one_speed = false;

  double rig_stiffness_N_per_m = 0.0;  // hidden; 0: rigid
  double plate_mass_kg = 0.0;          // Hidden: mass between load cell and bed, accelerated by the motion.
  std::map<std::string, ChannelFaults> faults;

  ChannelFaults faults_of(const std::string& channel) const {
    const auto found = faults.find(channel);
    return found == faults.end() ? ChannelFaults{} : found->second;
  }
};

// Prescribed motion of the plate's face; depth is positive downward.
struct Motion {
  Trace depth_m, speed_mps, acceleration_mps2;
};
// Motion for a set-up (impact_speed_mps, depth_m, profile), starting 20 mm above the surface.
Motion prescribed(const World& world, const Setup& setup);
// Height of the bed's surface above the zero of the prescribed motion in this trial.
double surface_m(const World& world, const TrialRandom& trial);

// Draws an apparatus, its belief, the set-ups of a campaign, and one recording.
World draw(Random& random);
Belief belief(const World& world);
std::vector<Setup> draw_setups(const World& world, int trials, Random& random);
Table record(const World& world, const Setup& setup, const TrialRandom& trial);
// Phase of the motion in each row of a recording (README.md).
std::vector<std::string> phases(const World& world, const Setup& setup, const TrialRandom& trial,
                                const Table& recorded);
std::vector<Recipe<World>> rig_effects();
std::vector<Restriction<World>> restrictions();

}  // namespace sandhopper::conceal::intruder
