#pragma once
#include "firmware/controller_config.hpp"
#include "tools/plant/world_config.hpp"

// Checks of what a trial is set to.
namespace sandhopper::paper {

// Speed at which the foot meets the surface after free fall from `height_m` [m/s].
double drop_speed_mps(const WorldConfig& world, double height_m, bool friction);

// dF/dL of the leg in stance, by its current, on samples whose torque is not at the limit [N/m].
struct LegStiffness {
  double compression_N_per_m;
  double extension_N_per_m;
};
LegStiffness leg_stiffness(const CycleConfig& cycle, const WorldConfig& world,
                           double compression_stiffness_N_per_m);

}  // namespace sandhopper::paper
