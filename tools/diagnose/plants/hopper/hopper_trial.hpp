#pragma once
#include <memory>
#include <string>
#include <vector>

#include "tools/diagnose/model/plant.hpp"

namespace sandhopper::diagnose {

inline constexpr double kRoom_C = 25.0;  // temperature of the stated torque constant

// Names of all predicted channels and of the phases of a hop; rows hold indices into them.
std::vector<std::string> hopper_channels();
std::vector<std::string> hopper_phases();

// Model of a recorded hop or hold. It is simulated by simulate_hopper() from its release, and from the start
// of every later hop, with the recorded phases, and read through the sensors. It has no rows if too little
// was recorded.
std::unique_ptr<TrialModel> hopper_trial(const Trial& trial, const Belief& belief);

}  // namespace sandhopper::diagnose
