#pragma once
#include <memory>
#include <string>
#include <vector>

#include "tools/diagnose/model/plant.hpp"

namespace sandhopper::diagnose {

inline constexpr double kRoom_C = 25.0;  // what a motor's constant is of

// Every channel that a run of the robot predicts, and parts of a hop; rows name them by their place here.
std::vector<std::string> hopper_channels();
std::vector<std::string> hopper_phases();

// A recorded hop or hold, simulated from its release (and from the start of every later hop) with the
// recorded phase schedule: simulate_hopper, read through the sensors. Without rows where hardly anything was
// recorded.
std::unique_ptr<TrialModel> hopper_trial(const Trial& trial, const Belief& belief);

}  // namespace sandhopper::diagnose
