#pragma once
#include "firmware/controller_config.hpp"
#include "tools/plant/world_config.hpp"

// Checks of a trial's set-up.
namespace sandhopper::paper {

// Speed [m/s] at which the foot meets the surface after a fall from `height_m`.
double drop_speed_mps(const WorldConfig& world, double height_m, bool friction);

// dF/dL [N/m] of the leg in stance, from its current, for samples whose torque is below the limit.
struct LegStiffness {
  double compression_N_per_m;
  double extension_N_per_m;
};
LegStiffness leg_stiffness(const CycleConfig& cycle, const WorldConfig& world,
                           double compression_stiffness_N_per_m);

}  // namespace sandhopper::paper
