#include "tools/calibrate/line.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "terrain/trial_statistics.hpp"

namespace sandhopper::calibrate {
namespace {

double sum(std::span<const double> values) {
  double out = 0.0;
  for (const double v : values) out += v;
  return out;
}

}  // namespace

Line fit_line(std::span<const double> x, std::span<const double> y, double least_sd) {
  const double n = static_cast<double>(x.size());
  const double x_mean = sum(x) / n, y_mean = sum(y) / n;
  double xx = 0.0, xy = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - x_mean) * (x[i] - x_mean);
    xy += (x[i] - x_mean) * (y[i] - y_mean);
  }
  Line out;
  out.slope = xy / xx;
  out.intercept = y_mean - out.slope * x_mean;
  double squares = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    out.residual.push_back(y[i] - out.at(x[i]));
    squares += out.residual.back() * out.residual.back();
    out.largest_residual = std::max(out.largest_residual, std::abs(out.residual.back()));
  }
  out.residual_sd = std::sqrt(squares / (n - 2.0));
  const double half = student_t95(x.size() - 2) * std::max(out.residual_sd, least_sd);
  out.slope_ci95 = half / std::sqrt(xx);
  out.intercept_ci95 = half * std::sqrt(1.0 / n + x_mean * x_mean / xx);
  return out;
}

std::optional<LineWithoutOne> line_without_worst(std::span<const double> x, std::span<const double> y) {
  if (x.size() < 5) return std::nullopt;
  std::optional<LineWithoutOne> best;
  for (std::size_t k = 0; k < x.size(); ++k) {
    std::vector<double> others_x(x.begin(), x.end()), others_y(y.begin(), y.end());
    others_x.erase(others_x.begin() + static_cast<std::ptrdiff_t>(k));
    others_y.erase(others_y.begin() + static_cast<std::ptrdiff_t>(k));
    const auto line = fit_line(others_x, others_y, 0.0);
    if (!best || line.largest_residual < best->largest_residual) best = {k, line.largest_residual};
  }
  return best;
}

std::optional<Curvature> curvature(std::span<const double> x, std::span<const double> y) {
  const auto n = static_cast<Eigen::Index>(x.size());
  if (n < 4) return std::nullopt;
  const double reach = std::abs(*std::ranges::max_element(x, {}, [](double v) { return std::abs(v); }));
  Eigen::MatrixX3d design(n, 3);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double u = x[static_cast<std::size_t>(i)] / reach;
    design.row(i) << 1.0, u, u * u;
  }
  const Eigen::Map<const Eigen::VectorXd> values(y.data(), n);
  const Eigen::Matrix3d normal = design.transpose() * design;
  const Eigen::LDLT<Eigen::Matrix3d> solver(normal);
  const Eigen::Vector3d fit = solver.solve(design.transpose() * values);
  const double sd = std::sqrt((values - design * fit).squaredNorm() / static_cast<double>(n - 3));
  const double variance = solver.solve(Eigen::Vector3d::UnitZ()).z();
  return Curvature{fit.z() / (sd * std::sqrt(variance)), student_t95(x.size() - 3)};
}

}  // namespace sandhopper::calibrate
