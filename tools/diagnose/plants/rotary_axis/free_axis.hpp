#pragma once
#include <cstddef>
#include <optional>
#include <vector>

#include "tools/diagnose/model/trial.hpp"

namespace sandhopper::diagnose {

// Numbers of trials in which nothing drives the axis.
struct FreeAxes {
  std::size_t without_torque = 0;  // without a recorded torque; it is 0 now
  std::size_t held = 0;            // begin while something holds the axis
  double longest_held_s = 0.0;
};

// Completes the torque of an axis that runs free, e.g. a pendulum, wheel or cart. If no trial has torque_Nm,
// or the motor was off, it becomes 0. Until a free axis is released, the torque that holds it is unknown, and
// torque_Nm becomes NaN. `motor_on`: per trial, from the set-up.
FreeAxes take_free_axes(std::vector<Trial>& trials, const std::vector<std::optional<bool>>& motor_on);

// Release of an axis that was held, s: the time at which it has moved by 1 % of its range, or out of the
// noise. Empty if it moves from the first row on. From rest it moves as (t - t_0)^2, so the times t_1 and t_2
// at which it has moved by d_1 and d_2 give the end of the hold:
//   t_0 = t_1 - (t_2 - t_1) / (sqrt(d_2 / d_1) - 1)
std::optional<double> let_go_s(const Trial& trial);

}  // namespace sandhopper::diagnose
