#pragma once
#include <vector>

#include "tools/diagnose/model/signal.hpp"
#include "tools/diagnose/plants/rotary_axis/rotary_figures.hpp"

namespace sandhopper::diagnose {

// A stretch of a motion, and the state in which it begins.
struct AxisStretch {
  double from_s, to_s, position = 0.0, velocity = 0.0;
  // Added to the recorded torque: mean, and rise from the mean to the end.
  double torque_Nm = 0.0, torque_rise_Nm = 0.0;
};

// Torque of the drive and the angle at which the axis last turned, both on one grid of times from zero on.
struct AxisInputs {
  const Signal& torque;
  const Signal& turned_at;
  bool is_driven;
};

// Simulates angle and speed over a stretch, from `lead_in_s` before it on, on the grid of the torque:
//   J th'' = torque - G sin(th - bottom) - c tanh(th'/v_s) - b th' + laws
// A driven axis in classical Runge-Kutta steps of fourth order, shorter ones near rest, where friction is
// stiff; an axis that nothing drives in controlled steps. `position` and `velocity` are overwritten; their
// memory is reused.
void simulate_axis(const RotaryFigures& figures, const std::vector<const Law*>& laws,
                   const AxisInputs& inputs, const AxisStretch& stretch, double lead_in_s, Signal& position,
                   Signal& velocity);

}  // namespace sandhopper::diagnose
