#pragma once
#include <memory>

#include "tools/diagnose/model/plant.hpp"

namespace sandhopper::diagnose {

// A foot moved by an actuator as recorded, into a bed. Channel force_N.
std::unique_ptr<PlantModel> make_intruder();

}  // namespace sandhopper::diagnose
