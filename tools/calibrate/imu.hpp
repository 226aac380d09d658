#pragma once
#include <string>
#include <vector>

#include "tools/calibrate/outcome.hpp"
#include "tools/calibrate/recording.hpp"

namespace sandhopper::calibrate {

// Gravity at the place of the recordings, and limits of an acceptable fit. A larger value is a refusal.
struct ImuLimits {
  double gravity_mps2;
  double max_residual_mps2 = 0.05;  // of the length of a pose's mean, beyond noise
  double max_bias_ci95_mps2 = 0.05;
  double max_scale_ci95 = 0.005;
  double max_gyro_ci95_radps = 0.01;
};

// Selects the IMU: its table in the board's file and its samples in a recording.
struct ImuChoice {
  std::string table;  // for example "imu_body"
  std::vector<ImuSample> Recording::*samples;
};

// Scale and bias of an accelerometer along its own axes, from still poses in any orientation. Only gravity
// acts: with m_k the uncorrected mean of pose k,
//   |S (m_k - b)| = g,  S diagonal,
// solved by Gauss-Newton for six unknowns. Intervals are Student's t on n - 6 degrees of freedom, with the
// residual at least the noise of the means. Cross-axis terms and the rotation of the mounting are not
// changed. The gyro's bias is the mean over the same poses, with its interval over the poses.
//
// Refusals: too_few_points (fewer than nine poses); poses_too_alike (no pose near one of the six faces); a
// pose that moves, drifts or slips; saturated (a pose at the end of the range); outlier (one pose that does
// not fit the others); residual_too_large; interval_too_wide.
Outcome calibrate_imu(const std::vector<Recording>& poses, const ImuChoice& which, const ImuConfig& before,
                      const ImuLimits& limits);

}  // namespace sandhopper::calibrate
