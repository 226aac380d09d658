#pragma once
#include <cstddef>
#include <optional>
#include <vector>

#include "tools/diagnose/model/trial.hpp"

namespace sandhopper::diagnose {

// Trials of an axis that nothing drives.
struct FreeAxes {
  std::size_t without_torque = 0;  // that recorded none: it is 0 now
  std::size_t held = 0;            // that begin while something holds the axis
  double longest_held_s = 0.0;
};

// A pendulum, wheel or cart that runs free has no torque to record: where no trial has any, or the motor was
// off, torque_Nm becomes 0. Until a free axis is let go its torque is whatever holds it, and becomes unknown.
// `motor_on`: of each trial, as the experimenter wrote it down.
FreeAxes take_free_axes(std::vector<Trial>& trials, const std::vector<std::optional<bool>>& motor_on);

// The time at which an axis that was held has moved by a hundredth of how far it gets, or out of the noise,
// s; empty where it moved from the first row on. From rest it moves as (t - t_0)^2, so that the times t_1 and
// t_2 at which it has moved by d_1 and d_2 tell when it was let go, t_0 = t_1 - (t_2 - t_1) / (sqrt(d_2 /
// d_1) - 1).
std::optional<double> let_go_s(const Trial& trial);

}  // namespace sandhopper::diagnose
