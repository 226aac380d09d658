#pragma once
#include <span>
#include <vector>

namespace sandhopper {

// Position, velocity and acceleration of one axis, computed after the trial from a camera that samples the
// position at some instants and an accelerometer with drifting bias. Kalman filter forward and
// Rauch-Tung-Striebel smoother backward over
//   x = [z, v, b],  z+ = z + v T + (a - b) T^2/2,  v+ = v + (a - b) T,  b+ = b + w
// with a the measured acceleration (gravity removed; a constant remainder goes into b) and T the time between
// two samples.
struct MotionNoise {
  double position_m = 2e-4;      // standard deviation of one position sample
  double accel_mps2 = 0.5;       // standard deviation of the acceleration over one step
  double bias_mps2 = 0.5;        // standard deviation of b at the start
  double bias_walk_mps2 = 0.05;  // standard deviation of the change of b in one second
};

struct SmoothMotion {
  std::vector<double> position_m;
  std::vector<double> velocity_mps;
  std::vector<double> accel_mps2;  // measured minus bias
};

// Times must strictly increase. NaN means no sample in that row. The acceleration is held between its
// samples. Without any acceleration sample it is taken as zero, with process noise large enough to follow the
// positions. Fewer than two positions give NaN everywhere.
SmoothMotion smooth_motion(std::span<const double> t_s, std::span<const double> position_m,
                           std::span<const double> accel_mps2, const MotionNoise& noise = {});

}  // namespace sandhopper
