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
  double largest_residual = 0.0;  // of the absolute values
  std::vector<double> residual;

  double at(double x) const { return intercept + slope * x; }
};

// At least three points, two of them with different x. The residual's standard deviation is taken to be no
// smaller than `least_sd`, the points' own errors: three points may lie on a line by luck.
Line fit_line(std::span<const double> x, std::span<const double> y, double least_sd);

// The line through all points but the one whose leaving out helps most; from five points on, since among
// fewer any one could be the odd one out.
struct LineWithoutOne {
  std::size_t left_out;
  double largest_residual;  // of the others
};
std::optional<LineWithoutOne> line_without_worst(std::span<const double> x, std::span<const double> y);

// t value of a square term beside the line, and its 95 % critical value; from four points on.
struct Curvature {
  double t;
  double t95;
};
std::optional<Curvature> curvature(std::span<const double> x, std::span<const double> y);

}  // namespace sandhopper::calibrate
