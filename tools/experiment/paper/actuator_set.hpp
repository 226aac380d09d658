#pragma once
#include <cstdint>
#include <vector>

#include "tools/plant/world_config.hpp"

// The actuator experiment: the foot is driven into a fresh bed at constant speed while the load cell
// measures.
namespace sandhopper::paper {

struct ActuatorSetup {
  int speeds = 50;
  double speed_increment_mps = 0.022;  // 0.022 to 1.1 m/s in 50 steps
  int trials = 3;                      // per speed, each in its own bed
  double stroke_m = 0.050;
  std::uint64_t first_seed = 1;
  bool align_amplifier = true;  // take the depth one amplifier time constant before the conversion
};

struct ActuatorSample {
  double depth_m;
  double force_N;
};

// One stroke: one sample per conversion of the load cell, with the depth that belongs to its force.
struct ActuatorRun {
  double speed_mps;
  std::vector<ActuatorSample> samples;
};

// Beds vary between trials with the spread of `world`. The force passes the amplifier and the converter.
std::vector<ActuatorRun> run_actuator_set(const WorldConfig& world, const ActuatorSetup& setup);

}  // namespace sandhopper::paper
