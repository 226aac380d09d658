#pragma once
#include <vector>

#include "tools/calibrate/outcome.hpp"
#include "tools/calibrate/recording.hpp"

namespace sandhopper::calibrate {

// The body held still at a known height.
struct HeightPoint {
  double height_m;  // of the hip axis over the surface
  Recording recording;
};

struct TofLimits {
  double max_ci95_m = 0.003;
  double max_residual_m = 0.004;  // on top of what noise explains
  double max_slope_error = 0.02;  // of reading against height
};

// Offset of the time-of-flight sensor: mount_offset' = mount_offset + mean of (height - reading), interval by
// Student's t over the heights.
//
// Refused: fewer than three different heights (too_few_points), a body that moves, drifts or slips, a height
// that does not fit the others (outlier), readings that do not grow as the heights do (wrong_slope), the
// residual (residual_too_large), the interval (interval_too_wide).
Outcome calibrate_tof(const std::vector<HeightPoint>& points, const TofConfig& before,
                      const TofLimits& limits = {});

}  // namespace sandhopper::calibrate
