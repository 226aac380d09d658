#pragma once
#include <vector>

#include "tools/diagnose/model/trial.hpp"
#include "tools/diagnose/plants/inputs.hpp"

namespace sandhopper::diagnose {

// The recorded motion of an intruder's foot on one grid of time, down positive, with the standard deviations
// of what is left of its sensors' noise.
struct IntruderMotion {
  double start_s = 0.0, step_s = 1e-3;
  std::vector<double> depth_m, speed_mps, accel_mps2;
  double depth_sd_m = 0.0, speed_sd_mps = 0.0;
  std::vector<double> accel_sd_mps2;  // a derived one is least sure where it changes fast
  // Where these were not recorded.
  bool speed_from_position = false, accel_from_position = false;
};

// Heights z, velocities v and accelerations a upward; v and a may be empty. Where accelerations were recorded
// and agree in time with the position they are joined by a Kalman smoother (Rauch, Tung and Striebel 1965) of
// x = (z, v, b, l) driven by a, on the finer of their grids:
//   z' = v, v' = a - b + l a', b' = l' = 0,   b: the accelerometer's offset, free; l: its lateness, to within
//   one of its samples, for it may give means over them;
// noise of z, v and a from their own fast fluctuation; a's is joined by 1 % of it (scale) and by change /
// sqrt(12) of it between two steps, for it may have jumped at any instant between; each sample of z and v is
// taken at its own time. Otherwise speeds and accelerations come from local parabolas over n samples, with a
// standard deviation of
//   s sqrt(12/n^3)/dt from speeds, s sqrt(720/n^5)/dt^2 from positions,
// and what parabolas twice as long make of it as what they flatten. Over gaps of one the smoother goes by the
// others. Where the foot is fast the grid is finer than the recording's.
IntruderMotion intruder_motion(const Samples& z, const Samples& v, const Samples& a);

// Whether the recorded position is late, or its clock runs otherwise, against the recorded velocity v or,
// where there is none, acceleration a; trials as units. With position late by L and its clock fast by d,
//   z' - v = -L v' - d (v + t v')     z'' - a = -L a' - d (2 a + t a')
// False where neither was recorded.
bool position_is_out_of_time(const std::vector<Trial>& trials);

}  // namespace sandhopper::diagnose
