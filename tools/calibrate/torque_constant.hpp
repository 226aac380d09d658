#pragma once
#include <vector>

#include "estimation/leg.hpp"
#include "tools/calibrate/outcome.hpp"
#include "tools/calibrate/recording.hpp"

namespace sandhopper::calibrate {

// Torques of a slow press against the load cell, with body and foot clamped: the left motor up and down, the
// right one, then both together; up and down `ramp_s` each, `pause_s` before each. Negative torque lengthens
// the leg.
struct PressProgram {
  double peak_torque_Nm;  // of each motor
  double ramp_s = 1.5;
  double pause_s = 0.3;
  int motor_count = 2;

  double duration_s() const;
  std::array<double, kMotorCount> torque_Nm(double time_s) const;
};

struct TorqueConstantSetup {
  double load_cell_ci95_relative = 0.0;  // of its scale: an error there is one of the torque constants
  double max_ci95_relative = 0.03;
  double max_residual_of_span = 0.03;
};

// Torque constant of each motor from presses on a calibrated load cell. Statics of the clamped leg, L' =
// dL/dphi, u = -current, F = force:
//   |L'| F = k_left u_left + k_right u_right + o - f s,   s = +1 where the press grows, -1 where it fades,
// with the offsets of cell, current and cogging in o and Coulomb friction f, which loading and unloading
// separate; bins of 50 ms, those within a fifth of a ramp of a turning point left out, where friction changes
// its sign gradually. One fit a recording; the values are the means over the recordings with Student's t, the
// load cell's own interval added in quadrature.
//
// Refused: fewer than three presses (too_few_points), a leg that moves (moving), a cell at its end
// (saturated), hardly any force (too_little_force), a residual that such a leg does not leave
// (residual_too_large), presses that disagree or intervals too wide (interval_too_wide), a constant that is
// not positive (wrong_sign).
Outcome calibrate_torque_constant(const std::vector<Recording>& presses, const LinuxBoardConfig& board,
                                  const Leg& leg, const TorqueConstantSetup& setup);

}  // namespace sandhopper::calibrate
