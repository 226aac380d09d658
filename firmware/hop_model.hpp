#pragma once
#include "firmware/controller.hpp"
#include "terrain/next_stride.hpp"

namespace sandhopper {

// Model of the robot for planning the next stride: two masses, lengths and stiffness of the leg, and the
// largest push of its motors.
HopModel hop_model_of(const CycleConfig& cycle);

}  // namespace sandhopper
