#pragma once
#include <memory>

#include "tools/diagnose/model/plant.hpp"

namespace sandhopper::diagnose {

// The robot on its rail: release, stances, flights. Channels: both motors' position, velocity, current and
// command, both accelerometers, time of flight, load cell, motion capture; any may be missing.
std::unique_ptr<PlantModel> make_hopper();

}  // namespace sandhopper::diagnose
