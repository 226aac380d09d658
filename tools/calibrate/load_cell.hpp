#pragma once
#include <vector>

#include "tools/calibrate/outcome.hpp"
#include "tools/calibrate/recording.hpp"

namespace sandhopper::calibrate {

// One weight, standing still on the load cell.
struct WeighedPoint {
  double mass_kg;
  Recording recording;  // forces with the configuration `before` below
};

struct LoadCellLimits {
  double gravity_mps2;
  double max_ci95_relative = 0.01;      // of the scale
  double max_residual_of_span = 0.005;  // allowed of the largest force on top of what noise explains
};

// Scale, zero and sign of the load cell from known weights: the means y_i of the recordings against the
// weights F_i = m_i g, y = a + b F by least squares; with the voltage V in place of y,
//   scale' = scale / |b|,  sign' = sign of b . sign,  zero' = V at F = 0.
// Intervals are Student's t on n - 2 degrees of freedom, the residual's standard deviation no smaller than
// that of the means. "Zero" is whatever lies on the cell in every recording.
//
// Refused: fewer than three different weights (too_few_points), a weight that moves, drifts or slips, a
// converter at its end (saturated), one weight that does not fit the others (outlier), a bent line
// (nonlinear), a repeated weight that gives another figure (repeats_disagree), the residual of the whole
// (residual_too_large), an interval wider than max_ci95_relative (interval_too_wide).
Outcome calibrate_load_cell(const std::vector<WeighedPoint>& points, const LoadCellConfig& before,
                            const LoadCellLimits& limits);

}  // namespace sandhopper::calibrate
