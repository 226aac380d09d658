#pragma once
#include <vector>

#include "tools/calibrate/outcome.hpp"
#include "tools/calibrate/recording.hpp"

namespace sandhopper::calibrate {

// The body held still at a known height.
struct HeightPoint {
  double height_m;  // of the hip axis above the surface
  Recording recording;
};

// Limits of an acceptable fit. A larger value is a refusal.
struct TofLimits {
  double max_ci95_m = 0.003;
  double max_residual_m = 0.004;  // beyond noise
  double max_slope_error = 0.02;  // of the slope of reading against height, from 1
};

// Offset of the time-of-flight sensor: mount_offset' = mount_offset + mean of (height - reading). The
// interval is Student's t over the heights.
//
// Refusals: too_few_points (fewer than three different heights); a body that moves, drifts or slips; outlier
// (one height that does not fit the others); wrong_slope (the slope of reading against height is not 1);
// residual_too_large; interval_too_wide.
Outcome calibrate_tof(const std::vector<HeightPoint>& points, const TofConfig& before,
                      const TofLimits& limits = {});

}  // namespace sandhopper::calibrate
