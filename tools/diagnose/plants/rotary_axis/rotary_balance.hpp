#pragma once
#include "tools/diagnose/model/plant.hpp"

namespace sandhopper::diagnose {

inline constexpr double kTurn_rad = 0.01;  // a motion that comes back by more has reversed

// Torque that the recorded motion needs beyond the believed and the recorded one:
//   J th'' + G sin(th - bottom) + b th' + c tanh(th' / v_s) - torque
// Empty without position_rad and torque_Nm.
std::vector<Balance> balances_of_axis(const Trial& trial, const Belief& belief);

}  // namespace sandhopper::diagnose
