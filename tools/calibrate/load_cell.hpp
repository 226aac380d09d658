#pragma once
#include <vector>

#include "tools/calibrate/outcome.hpp"
#include "tools/calibrate/recording.hpp"

namespace sandhopper::calibrate {

// One weight that stands still on the load cell.
struct WeighedPoint {
  double mass_kg;
  Recording recording;  // forces converted with the configuration `before`
};

// Gravity at the place of the recordings, and limits of an acceptable fit. A larger value is a refusal.
struct LoadCellLimits {
  double gravity_mps2;
  double max_ci95_relative = 0.01;      // of the scale
  double max_residual_of_span = 0.005;  // share of the largest force, beyond noise
};

// Scale, zero and sign of the load cell from known weights. Least squares of the mean readings y_i on the
// weights F_i = m_i g: y = a + b F. Then, with V the voltage,
//   scale' = scale / |b|,  sign' = sign(b) . sign,  zero' = V at F = 0.
// Intervals are Student's t on n - 2 degrees of freedom, with the standard deviation of the residual at least
// that of the means. A load that lies on the cell in every recording becomes part of the zero.
//
// Refusals: too_few_points (fewer than three different weights); a weight that moves, drifts or slips;
// saturated (the converter at its end); outlier (one weight that does not fit the others); nonlinear (the
// readings are curved); repeats_disagree (one weight, two readings); residual_too_large; interval_too_wide
// (wider than max_ci95_relative).
Outcome calibrate_load_cell(const std::vector<WeighedPoint>& points, const LoadCellConfig& before,
                            const LoadCellLimits& limits);

}  // namespace sandhopper::calibrate
