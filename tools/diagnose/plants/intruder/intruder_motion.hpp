#pragma once
#include <vector>

#include "tools/diagnose/model/trial.hpp"
#include "tools/diagnose/plants/inputs.hpp"

namespace sandhopper::diagnose {

// The recorded motion of an intruder's foot on one time grid, down positive, with the standard deviations of
// the noise that remains.
struct IntruderMotion {
  double start_s = 0.0, step_s = 1e-3;
  std::vector<double> depth_m, speed_mps, accel_mps2;
  double depth_sd_m = 0.0, speed_sd_mps = 0.0;
  std::vector<double> accel_sd_mps2;  // larger where a derived acceleration changes fast
  // True if the quantity was not recorded and comes from the position.
  bool speed_from_position = false, accel_from_position = false;
};

// Motion from recorded heights z, velocities v and accelerations a, which are upward; v and a may be empty.
//
// If accelerations were recorded and agree in time with the position, a Kalman smoother (Rauch, Tung and
// Striebel 1965) joins the sensors on the finer of their grids. Its state is x = (z, v, b, l), driven by a:
//   z' = v,  v' = a - b + l a',  b' = l' = 0
// b is the accelerometer's offset (free). l is its delay, within one of its samples, because it may give
// means over them. The noise of z, v and a comes from fluctuation_rms. That of a grows by 1 % of a (scale)
// and by the change of a between two steps / sqrt(12), because a may jump at any time in between. Each sample
// of z and v counts at its own time. Over a gap of one sensor the smoother uses the others.
//
// Otherwise speeds and accelerations come from local parabolas over n samples, with a standard deviation of
//   s sqrt(12/n^3)/dt from speeds, s sqrt(720/n^5)/dt^2 from positions,
// plus the difference from parabolas twice as long, for what they flatten.
//
// If the foot is fast, the grid is finer than that of the recording.
IntruderMotion intruder_motion(const Samples& z, const Samples& v, const Samples& a);

// True if the recorded position is late, or its clock has another rate, against the recorded velocity v or,
// without one, the acceleration a. The trials are the units of the test. With the position late by L and its
// clock fast by d:
//   z' - v = -L v' - d (v + t v')     z'' - a = -L a' - d (2 a + t a')
// False if neither v nor a was recorded.
bool position_is_out_of_time(const std::vector<Trial>& trials);

}  // namespace sandhopper::diagnose
