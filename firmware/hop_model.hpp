#pragma once
#include "firmware/controller.hpp"
#include "terrain/next_stride.hpp"

namespace sandhopper {

// The robot as the planner of the next stride takes it: two masses, the lengths and the stiffness of the leg,
// and what its motors can push.
HopModel hop_model_of(const CycleConfig& cycle);

}  // namespace sandhopper
