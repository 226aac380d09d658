#include "tools/terrain/stroke_map.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <limits>

namespace sandhopper {
namespace {

constexpr std::size_t kForce = StrokeSums::kRegressors;
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr double kAddedMassDepth_m = 0.030;
using Combination = Eigen::Matrix<double, StrokeSums::kColumns, 1>;
using Products = Eigen::Matrix<double, StrokeSums::kColumns, StrokeSums::kColumns>;

std::size_t place(std::size_t row, std::size_t column) {
  if (row > column) std::swap(row, column);
  return row * StrokeSums::kColumns - row * (row + 1) / 2 + column;
}

Products matrix(const StrokeSums& sums) {
  Products m;
  for (std::size_t i = 0; i < StrokeSums::kColumns; ++i)
    for (std::size_t j = 0; j < StrokeSums::kColumns; ++j)
      m(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = sums.at(i, j);
  return m;
}

// Least squares in the columns of `basis`, which are combinations of regressors. Columns are scaled to one.
Eigen::VectorXd solve(const Products& products, const Eigen::MatrixXd& basis) {
  Eigen::MatrixXd normal = basis.transpose() * products * basis;
  const Eigen::VectorXd right = basis.transpose() * products.col(kForce);
  const Eigen::VectorXd scale = normal.diagonal().cwiseSqrt().cwiseMax(1e-300).cwiseInverse();
  normal = scale.asDiagonal() * normal * scale.asDiagonal();
  const Eigen::LDLT<Eigen::MatrixXd> factors(normal);
  constexpr double kDegenerate = 1e-9;
  if (factors.info() != Eigen::Success || factors.vectorD().minCoeff() < kDegenerate)
    return Eigen::VectorXd::Constant(basis.cols(), kUnknown);
  return scale.asDiagonal() * factors.solve(scale.asDiagonal() * right);
}

// Sum of squares of a combination of columns.
double square_sum(const Products& products, const Combination& combination) {
  return std::max(0.0, combination.dot(products * combination));
}

Combination map_left(const StrokeMap& map) {
  Combination left = Combination::Zero();
  left(kForce) = 1.0;
  left(0) = -map.intercept_N;
  left(1) = -map.stiffness_N_per_m;
  for (Eigen::Index i = 0; i < 3; ++i) left(2 + i) = -map.drag_coefficient[static_cast<std::size_t>(i)];
  return left;
}

Combination added_mass_force(const StrokeMap& map) {
  Combination force = Combination::Zero();
  for (Eigen::Index i = 0; i < 3; ++i) force(5 + i) = map.drag_coefficient[static_cast<std::size_t>(i)];
  return force;
}

// Mean of jackknife pseudo-values with Student's interval.
TrialMean jackknife(double whole, const std::vector<double>& without_one) {
  const double n = static_cast<double>(without_one.size());
  std::vector<double> pseudo;
  pseudo.reserve(without_one.size());
  for (const double value : without_one) pseudo.push_back(n * whole - (n - 1.0) * value);
  auto mean = mean_over_trials(pseudo);
  const double shift = whole - mean.value;
  mean.value += shift;
  mean.ci95_low += shift;
  mean.ci95_high += shift;
  return mean;
}

}  // namespace

void StrokeSums::add(const StrokeSample& s) {
  const double z = s.depth_m, v2 = s.speed_mps * s.speed_mps, a = s.accel_mps2;
  const std::array<double, kColumns> column{
      1.0, z, v2, z * v2, z * z * v2, z * a, z * z * a / 2.0, z * z * z * a / 3.0, s.force_N};
  std::size_t k = 0;
  for (std::size_t i = 0; i < kColumns; ++i)
    for (std::size_t j = i; j < kColumns; ++j) products_[k++] += column[i] * column[j];
}

void StrokeSums::add(const StrokeSums& other) {
  for (std::size_t k = 0; k < products_.size(); ++k) products_[k] += other.products_[k];
}

double StrokeSums::at(std::size_t row, std::size_t column) const { return products_[place(row, column)]; }

StrokeSums StrokeSums::from(std::span<const double> numbers) {
  StrokeSums sums;
  if (numbers.size() == sums.products_.size())
    std::copy(numbers.begin(), numbers.end(), sums.products_.begin());
  return sums;
}

double StrokeMap::drag_kg_per_m(double z) const {
  return drag_coefficient[0] + drag_coefficient[1] * z + drag_coefficient[2] * z * z;
}

double StrokeMap::added_mass_kg(double z) const {
  return z * (drag_coefficient[0] + z * (drag_coefficient[1] / 2.0 + z * drag_coefficient[2] / 3.0));
}

StrokeMap fit_stroke_map(const StrokeSums& sums, StrokeTerms terms) {
  Eigen::MatrixXd basis = Eigen::MatrixXd::Zero(StrokeSums::kColumns, 5);
  for (Eigen::Index i = 0; i < 5; ++i) basis(i, i) = 1.0;
  if (terms == StrokeTerms::with_added_mass)
    for (Eigen::Index i = 0; i < 3; ++i) basis(5 + i, 2 + i) = 1.0;
  const auto solution = solve(matrix(sums), basis);
  return {solution(0), solution(1), {solution(2), solution(3), solution(4)}};
}

StrokeResiduals stroke_residuals(const StrokeSums& trial, const StrokeMap& map) {
  const auto products = matrix(trial);
  const double n = trial.samples();
  const auto rms = [&](const Combination& left) { return std::sqrt(square_sum(products, left) / n); };
  Eigen::MatrixXd line_basis = Eigen::MatrixXd::Zero(StrokeSums::kColumns, 2);
  line_basis(0, 0) = line_basis(1, 1) = 1.0;
  const auto line = solve(products, line_basis);
  Combination line_left = Combination::Zero();
  line_left(kForce) = 1.0;
  line_left(0) = -line(0);
  line_left(1) = -line(1);

  StrokeResiduals out;
  out.line_rms_N = rms(line_left);
  const Combination left = map_left(map), inertia = added_mass_force(map);
  out.map_rms_N = rms(left);
  out.added_mass_rms_N = rms(left - inertia);
  // Column 0 is 1, so the product with it is the sum of a combination over the samples.
  const auto mean = [&](const Combination& c) { return c.dot(products.col(0)) / n; };
  const double covariance = left.dot(products * inertia) / n - mean(left) * mean(inertia);
  const double spread = std::sqrt((square_sum(products, left) / n - mean(left) * mean(left)) *
                                  (square_sum(products, inertia) / n - mean(inertia) * mean(inertia)));
  out.correlation = spread > 0.0 ? covariance / spread : kUnknown;
  return out;
}

StrokeMapWithIntervals fit_stroke_map(std::span<const StrokeSums> trials, StrokeTerms terms) {
  StrokeSums all;
  for (const auto& trial : trials) all.add(trial);
  StrokeMapWithIntervals out;
  out.map = fit_stroke_map(all, terms);
  std::vector<StrokeMap> without;
  for (std::size_t left_out = 0; left_out < trials.size(); ++left_out) {
    StrokeSums rest;
    for (std::size_t i = 0; i < trials.size(); ++i)
      if (i != left_out) rest.add(trials[i]);
    without.push_back(fit_stroke_map(rest, terms));
  }
  const auto interval = [&](auto&& figure) {
    std::vector<double> values;
    values.reserve(without.size());
    for (const auto& map : without) values.push_back(figure(map));
    return jackknife(figure(out.map), values);
  };
  out.intercept_N = interval([](const StrokeMap& m) { return m.intercept_N; });
  out.stiffness_N_per_m = interval([](const StrokeMap& m) { return m.stiffness_N_per_m; });
  out.drag_at_surface_kg_per_m = interval([](const StrokeMap& m) { return m.drag_kg_per_m(0.0); });
  out.added_mass_at_30mm_kg = interval([](const StrokeMap& m) { return m.added_mass_kg(kAddedMassDepth_m); });
  return out;
}

}  // namespace sandhopper
