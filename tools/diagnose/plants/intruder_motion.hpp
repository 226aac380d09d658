#pragma once
#include <vector>

#include "tools/diagnose/plants/inputs.hpp"

namespace sandhopper::diagnose {

// The recorded motion of an intruder's foot on one grid of time, down positive, with the standard deviations
// of what is left of its sensors' noise.
struct IntruderMotion {
  double start_s = 0.0, step_s = 1e-3;
  std::vector<double> depth_m, speed_mps, accel_mps2;
  double depth_sd_m = 0.0, speed_sd_mps = 0.0, accel_sd_mps2 = 0.0;
  // Where these were not recorded.
  bool speed_from_position = false, accel_from_position = false;
};

// Heights z, velocities v and accelerations a upward; v and a may be empty. Where all three were recorded
// they are joined by a Kalman smoother (Rauch, Tung and Striebel 1965) of x = (z, v) driven by a:
//   z' = v, v' = a,   noise of z, v and a from their own fast fluctuation;
// otherwise speeds and accelerations come from local parabolas.
IntruderMotion intruder_motion(const Samples& z, const Samples& v, const Samples& a);

}  // namespace sandhopper::diagnose
