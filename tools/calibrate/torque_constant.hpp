#pragma once
#include <vector>

#include "estimation/leg.hpp"
#include "tools/calibrate/outcome.hpp"
#include "tools/calibrate/recording.hpp"

namespace sandhopper::calibrate {

// Torque program of a slow press on the load cell, with body and foot clamped: the left motor, the right one,
// then both. Each part is a pause of `pause_s` and a ramp up and down of `ramp_s` each. Negative torque
// lengthens the leg.
struct PressProgram {
  double peak_torque_Nm;  // of each motor
  double ramp_s = 1.5;
  double pause_s = 0.3;
  int motor_count = 2;

  double duration_s() const;
  // Torque of each motor at this time of the recording.
  std::array<double, kMotorCount> torque_Nm(double time_s) const;
};

// Uncertainty of the load cell, and limits of an acceptable fit relative to the constant and to the span of
// torque.
struct TorqueConstantSetup {
  double load_cell_ci95_relative = 0.0;  // of the load cell's scale; such an error is also one of the torque
                                         // constants
  double max_ci95_relative = 0.03;
  double max_residual_of_span = 0.03;
};

// Torque constant of each motor from presses on a calibrated load cell. Statics of the clamped leg with L' =
// dL/dphi, u = -current, F = force:
//   |L'| F = k_left u_left + k_right u_right + o - f s,  s = +1 while the press grows, -1 while it falls.
// o: offsets of cell, current and cogging. f: Coulomb friction; loading and unloading separate it. The data
// are bins of 50 ms. The first 0.3 s after a turning point are left out, because friction changes its sign
// gradually. One fit per recording; the result is the mean over the recordings with Student's t, and the load
// cell's own interval is added in quadrature.
//
// Refusals: too_few_points (fewer than three presses); moving (the leg moves); saturated (the cell at its
// end); too_little_force; residual_too_large; interval_too_wide (the presses differ); wrong_sign (a constant
// that is not positive).
Outcome calibrate_torque_constant(const std::vector<Recording>& presses, const LinuxBoardConfig& board,
                                  const Leg& leg, const TorqueConstantSetup& setup);

}  // namespace sandhopper::calibrate
