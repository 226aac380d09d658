#pragma once
#include <memory>

#include "tools/diagnose/model/plant.hpp"

namespace sandhopper::diagnose {

// An axis driven by its recorded torque, simulated in short blocks that each start from a state of their own,
// so that an error does not grow over the whole recording. Channels position_rad, velocity_radps.
std::unique_ptr<PlantModel> make_rotary_axis();

}  // namespace sandhopper::diagnose
