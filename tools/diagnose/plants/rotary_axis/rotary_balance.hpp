#pragma once
#include "tools/diagnose/model/plant.hpp"

namespace sandhopper::diagnose {

inline constexpr double kTurn_rad = 0.01;  // by which a motion must come back to have turned

// The torque that the recorded motion needs besides the drive's and the believed one; nothing without
// position_rad and torque_Nm.
std::vector<Balance> balances_of_axis(const Trial& trial, const Belief& belief);

}  // namespace sandhopper::diagnose
