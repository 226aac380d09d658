#include "terrain/stiffness_fit.hpp"

#include <algorithm>
#include <cmath>

namespace sandhopper {

double acceleration_weight(const WeightConfig& config, double accel_magnitude_mps2) noexcept {
  const double s =
      1.0 / (1.0 + std::exp(-config.slope_s2_per_m * (accel_magnitude_mps2 - config.threshold_mps2)));
  const double sigma = config.sigma_good_N + (config.sigma_bad_N - config.sigma_good_N) * s;
  return 1.0 / (sigma * sigma);
}

void RecursiveRegression::add(const FitSample& sample) noexcept {
  const double z = sample.depth_m;
  const double f = sample.force_N;
  const double w = sample.weight;
  const Products a{w * f, w, w * z, w * z * f, w * z * z};
  sums_.w += w;
  sums_.wz += a[2];
  sums_.wzz += a[4];
  sums_.wf += a[0];
  sums_.wzf += a[3];
  sums_.depth_min_m = sums_.samples == 0 ? z : std::min(sums_.depth_min_m, z);
  sums_.depth_max_m = sums_.samples == 0 ? z : std::max(sums_.depth_max_m, z);
  ++sums_.samples;

  for (std::size_t i = 0; i < 5; ++i) {
    distance_[i] += total_[i];
    total_[i] += a[i];
  }
  for (std::size_t i = 0; i < 5; ++i)
    for (std::size_t j = 0; j < 5; ++j) sums_.spread[5 * i + j] += a[i] * distance_[j];
}

namespace {

// -(1/n) sum_ij |i - j| (row . a_i)(row . a_j): the variance of the sum of the scores row . a_i.
double score_variance(const RegressionSums& sums, const std::array<double, 5>& row) {
  double total = 0.0;
  for (std::size_t i = 0; i < 5; ++i)
    for (std::size_t j = 0; j < 5; ++j) total += row[i] * sums.spread[5 * i + j] * row[j];
  return -2.0 * total / sums.samples;
}

struct Line {
  double intercept;
  double slope;
  double slope_variance;
};

Line solve_free(const RegressionSums& s) {
  const double det = s.w * s.wzz - s.wz * s.wz;
  const double slope = (s.w * s.wzf - s.wz * s.wf) / det;
  const double intercept = (s.wzz * s.wf - s.wz * s.wzf) / det;
  const std::array<double, 5> first{1.0, -intercept, -slope, 0.0, 0.0};
  const std::array<double, 5> second{0.0, 0.0, -intercept, 1.0, -slope};
  // Row of the inverse normal matrix that belongs to the slope.
  const double a = -s.wz / det;
  const double b = s.w / det;
  std::array<double, 5> row{};
  for (std::size_t i = 0; i < 5; ++i) row[i] = a * first[i] + b * second[i];
  return {intercept, slope, score_variance(s, row)};
}

Line solve_through_origin(const RegressionSums& s) {
  const double slope = s.wzf / s.wzz;
  const std::array<double, 5> row{0.0, 0.0, 0.0, 1.0 / s.wzz, -slope / s.wzz};
  return {0.0, slope, score_variance(s, row)};
}

Validity judge(const RegressionSums& sums, const StiffnessConfig& config, const StiffnessEstimate& e) {
  if (!std::isfinite(e.ci95_low_N_per_m) || !std::isfinite(e.ci95_high_N_per_m))
    return Validity::interval_unbounded;
  if (!(e.value_N_per_m > 0.0)) return Validity::not_positive;
  if (!(e.ci95_low_N_per_m > 0.0)) return Validity::interval_includes_zero;
  if (sums.depth_max_m > config.max_depth_m) return Validity::deeper_than_foot;
  return Validity::valid;
}

}  // namespace

StiffnessEstimate solve_stiffness(const RegressionSums& sums, const StiffnessConfig& config) noexcept {
  StiffnessEstimate e;
  e.samples = sums.samples;
  if (sums.samples == 0) {
    e.validity = Validity::no_new_penetration;
    return e;
  }
  if (sums.samples < config.min_samples) {
    e.validity = Validity::too_few_samples;
    return e;
  }
  if (sums.depth_max_m - sums.depth_min_m < config.min_depth_span_m) {
    e.validity = Validity::too_shallow;
    return e;
  }
  const Line line = config.free_intercept ? solve_free(sums) : solve_through_origin(sums);
  const double n = sums.samples;
  const double parameters = config.free_intercept ? 2.0 : 1.0;
  e.value_N_per_m = line.slope;
  e.intercept_N = line.intercept;
  e.standard_error_N_per_m = std::sqrt(std::max(line.slope_variance, 0.0) * n / (n - parameters));
  const double half = e.standard_error_N_per_m *
                      (config.free_intercept ? kCriticalValueFreeIntercept : kCriticalValueThroughOrigin);
  e.ci95_low_N_per_m = line.slope - half;
  e.ci95_high_N_per_m = line.slope + half;
  e.validity = judge(sums, config, e);
  return e;
}

}  // namespace sandhopper
