#pragma once
#include <cstddef>
#include <optional>
#include <vector>

#include "tools/diagnose/model/trial.hpp"

namespace sandhopper::diagnose {

// Numbers of trials in which nothing drives the axis.
struct FreeAxes {
  std::size_t without_torque = 0;  // without a recorded torque; it is 0 now
  std::size_t unstated = 0;        // of these, whose set-up does not state motor_enabled
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
//   t_0 = t_1 - r_1 (t_2 - t_1) / (r_2 - r_1),   r_i = sqrt(d_i + d_0)
// d_0: largest way in the other direction before t_1. A pendulum that swings through its turning point goes
// that way in the time t_0 r_0 / r_1, r_0 = sqrt(d_0), before it turns; this is no hold and is taken off.
std::optional<double> let_go_s(const Trial& trial);

}  // namespace sandhopper::diagnose
