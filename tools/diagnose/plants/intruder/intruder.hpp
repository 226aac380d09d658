#pragma once
#include <memory>

#include "tools/diagnose/model/plant.hpp"

namespace sandhopper::diagnose {

// A foot that an actuator moves into a bed. Its recorded motion is an input. Channel force_N.
std::unique_ptr<PlantModel> make_intruder();

}  // namespace sandhopper::diagnose
