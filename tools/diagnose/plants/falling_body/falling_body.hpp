#pragma once
#include <memory>

#include "tools/diagnose/model/plant.hpp"

namespace sandhopper::diagnose {

// A body that falls through a medium, perhaps onto a bed. Channels height_m and accel_mps2, and the condition
// touchdown_s.
std::unique_ptr<PlantModel> make_falling_body();

}  // namespace sandhopper::diagnose
