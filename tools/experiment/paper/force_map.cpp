#include "tools/experiment/paper/force_map.hpp"

#include <Eigen/Dense>
#include <cmath>

#include "tools/experiment/statistics.hpp"

namespace sandhopper::paper {

double ForceMap::force_N(double depth_m, double speed_mps) const {
  return intercept_N + stiffness_N_per_m * depth_m + mass_gradient_kg_per_m(depth_m) * speed_mps * speed_mps;
}

double ForceMap::mass_gradient_kg_per_m(double depth_m) const {
  const auto& [a, b, c] = drag_coefficient;
  return a + depth_m * (b + depth_m * c);
}

double ForceMap::added_mass_kg(double depth_m) const {
  const auto& [a, b, c] = drag_coefficient;
  return depth_m * (a + depth_m * (b / 2.0 + depth_m * c / 3.0));
}

ForceMap fit_force_map(std::span<const ActuatorRun> runs) {
  Eigen::Index rows = 0;
  for (const auto& run : runs) rows += static_cast<Eigen::Index>(run.samples.size());
  Eigen::MatrixXd terms(rows, 5);
  Eigen::VectorXd force(rows);
  Eigen::Index row = 0;
  for (const auto& run : runs) {
    const double v2 = run.speed_mps * run.speed_mps;
    for (const auto& [z, f] : run.samples) {
      terms.row(row) << 1.0, z, v2, z * v2, z * z * v2;
      force(row++) = f;
    }
  }
  const Eigen::VectorXd x = terms.colPivHouseholderQr().solve(force);
  const double residual = (force - terms * x).squaredNorm();
  const double spread = (force.array() - force.mean()).square().sum();
  return {.intercept_N = x(0),
          .stiffness_N_per_m = x(1),
          .drag_coefficient = {x(2), x(3), x(4)},
          .r_squared = 1.0 - residual / spread,
          .rms_N = std::sqrt(residual / static_cast<double>(rows)),
          .samples = static_cast<std::size_t>(rows)};
}

namespace {

struct Slopes {
  std::vector<double> free, through_origin;
};

Slopes slopes_of(std::span<const ActuatorRun> runs, double from_mps, double to_mps) {
  Slopes slopes;
  for (const auto& run : runs) {
    if (run.speed_mps < from_mps || run.speed_mps > to_mps) continue;
    std::vector<double> z, f;
    double zf = 0.0, zz = 0.0;
    for (const auto& [depth_m, force_N] : run.samples) {
      z.push_back(depth_m);
      f.push_back(force_N);
      zf += depth_m * force_N;
      zz += depth_m * depth_m;
    }
    slopes.free.push_back(fit_line(z, f).slope);
    slopes.through_origin.push_back(zf / zz);
  }
  return slopes;
}

}  // namespace

StiffnessDefinitions stiffness_by_definition(std::span<const ActuatorRun> runs, const ForceMap& map,
                                             double bed_stiffness_N_per_m, double inertial_speed_mps) {
  const auto slow = slopes_of(runs, 0.0, inertial_speed_mps);
  const auto all = slopes_of(runs, 0.0, 10.0);
  const auto fast = slopes_of(runs, 1.0, 10.0);
  return {.slow_free_intercept = mean(slow.free),
          .slow_through_origin = mean(slow.through_origin),
          .map_coefficient = map.stiffness_N_per_m,
          .all_runs_free_intercept = mean(all.free),
          .fastest_free_intercept = mean(fast.free),
          .bed = bed_stiffness_N_per_m};
}

}  // namespace sandhopper::paper
