#pragma once
#include <vector>

#include "tools/conceal/hopper/dynamics.hpp"

namespace sandhopper::conceal::hopper {

// A simulated trial: true traces, four samples per cycle, and what the controller read and did in each cycle.
struct Run {
  Trace body_m, foot_m, body_mps2, foot_mps2, contact_N, current_A;
  struct Cycle {
    double angle_rad, angle_rate_radps;  // reading, and its filtered derivative
    double foot_rate_mps, torque_Nm, command_Nm, deepest_m;
    double temperature_C;
    int phase;
  };
  std::vector<Cycle> cycles;
};

// Throws std::invalid_argument for a kind of trial that this robot cannot do.
Run simulate(const World& world, const Setup& setup, const TrialRandom& trial);

}  // namespace sandhopper::conceal::hopper
