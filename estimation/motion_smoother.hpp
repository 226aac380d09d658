#pragma once
#include <span>
#include <vector>

namespace sandhopper {

// Position, velocity and acceleration of one axis after the trial, from a camera that sees the position now
// and then and an accelerometer that drifts: Kalman filter forward, Rauch-Tung-Striebel smoother backward
// over
//   x = [z, v, b],  z+ = z + v T + (a - b) T^2/2,  v+ = v + (a - b) T,  b+ = b + w
// a the measured acceleration (gravity taken off; any constant left is in b), T the step between two samples.
struct MotionNoise {
  double position_m = 2e-4;      // of one position sample
  double accel_mps2 = 0.5;       // of the acceleration over one step
  double bias_mps2 = 0.5;        // of b at the start
  double bias_walk_mps2 = 0.05;  // of b over one second
};

struct SmoothMotion {
  std::vector<double> position_m;
  std::vector<double> velocity_mps;
  std::vector<double> accel_mps2;  // measured minus bias
};

// Times grow strictly; NaN: no sample in that row. Acceleration is held between its samples. Without any
// acceleration it is taken as zero with noise enough to follow the positions. Needs two positions: else every
// value is NaN.
SmoothMotion smooth_motion(std::span<const double> t_s, std::span<const double> position_m,
                           std::span<const double> accel_mps2, const MotionNoise& noise = {});

}  // namespace sandhopper
