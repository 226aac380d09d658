#pragma once
#include <string>
#include <vector>

#include "tools/calibrate/outcome.hpp"
#include "tools/calibrate/recording.hpp"

namespace sandhopper::calibrate {

struct ImuLimits {
  double gravity_mps2;
  double max_residual_mps2 = 0.05;  // of a pose's length, on top of what noise explains
  double max_bias_ci95_mps2 = 0.05;
  double max_scale_ci95 = 0.005;
  double max_gyro_ci95_radps = 0.01;
};

// Which IMU: its table in the board's file, and its samples in a recording.
struct ImuChoice {
  std::string table;  // "imu_body"
  std::vector<ImuSample> Recording::*samples;
};

// Scale and bias of an accelerometer along its own axes from still poses, gravity being all there is,
// whatever the orientation: with m_k the mean of pose k as the sensor delivers it,
//   | S (m_k - b) | = g,   S diagonal,
// by Gauss-Newton on the six unknowns. Intervals are Student's t on n - 6 degrees of freedom, the residual no
// smaller than the noise of the means. Cross-axis terms and the mounting's rotation stay as they are. The
// gyro's bias is its mean over the same poses, interval over the poses.
//
// Refused: fewer than nine poses (too_few_points), no pose near one of the six faces (poses_too_alike), a
// pose that moves, drifts or slips, one at the end of the range (saturated), one that does not fit the others
// (outlier), the residual of all (residual_too_large), an interval (interval_too_wide).
Outcome calibrate_imu(const std::vector<Recording>& poses, const ImuChoice& which, const ImuConfig& before,
                      const ImuLimits& limits);

}  // namespace sandhopper::calibrate
