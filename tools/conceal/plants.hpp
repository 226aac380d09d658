#pragma once
#include "tools/conceal/core/plant.hpp"

namespace sandhopper::conceal {

const Plant& rotary_axis_plant();
const Plant& falling_body_plant();
const Plant& intruder_plant();
const Plant& hopper_plant();

}  // namespace sandhopper::conceal
