#pragma once
#include <optional>
#include <span>
#include <vector>

namespace sandhopper::calibrate {

// y = intercept + slope x by ordinary least squares, with half-widths of the 95 % intervals (Student's t on n
// - 2 degrees of freedom).
struct Line {
  double intercept = 0.0;
  double slope = 0.0;
  double intercept_ci95 = 0.0;
  double slope_ci95 = 0.0;
  double residual_sd = 0.0;
  double largest_residual = 0.0;  // largest absolute value of `residual`
  std::vector<double> residual;

  double at(double x) const { return intercept + slope * x; }
};

// Needs at least three points with at least two different x. `least_sd`: error of a single point. The
// intervals use at least this standard deviation, because three points may lie on a line by chance.
Line fit_line(std::span<const double> x, std::span<const double> y, double least_sd);

// Leaves out the one point whose removal reduces the largest residual most. Needs five points: among fewer,
// any of them could be the outlier.
struct LineWithoutOne {
  std::size_t left_out;
  double largest_residual;  // largest residual of the other points
};
std::optional<LineWithoutOne> line_without_worst(std::span<const double> x, std::span<const double> y);

// t value of an added square term, and its 95 % critical value. Needs four points.
struct Curvature {
  double t;
  double t95;
};
std::optional<Curvature> curvature(std::span<const double> x, std::span<const double> y);

}  // namespace sandhopper::calibrate
