#include "terrain/joint_fit.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace sandhopper {
namespace {

using Matrix = Eigen::Matrix<double, static_cast<int>(kJointTerms), static_cast<int>(kJointTerms)>;
using Vector = Eigen::Matrix<double, static_cast<int>(kJointTerms), 1>;

constexpr int at(JointTerm term) { return static_cast<int>(term); }

BedParameters unit_cone() {
  BedParameters bed;
  bed.added_mass_factor = 1.0;
  return bed;
}

}  // namespace

JointRegression::JointRegression(const JointConfig& config, double foot_radius_m)
    : config_(config), cone_(unit_cone(), foot_radius_m) {}

void JointRegression::add(const JointSample& s) noexcept {
  if (!(std::abs(s.accel_mps2) < config_.accel_range_mps2)) {
    ++sums_.saturated;
    return;
  }
  if (!(s.depth_m > 0.0)) return;
  const double new_ground = s.speed_mps * std::max(s.duration_s, 0.0) / config_.fluctuation_length_m;
  const double share = std::clamp(new_ground, 0.0, 1.0);
  const double fluctuation = config_.fluctuation_relative * s.force_N;
  const double weight = share / (config_.force_noise_N * config_.force_noise_N + fluctuation * fluctuation);
  if (!std::isfinite(weight)) return;

  std::array<double, kJointTerms> x{};
  x[at(JointTerm::stiffness)] = s.depth_m;
  x[at(JointTerm::intercept)] = 1.0 - std::exp(-s.depth_m / config_.intercept_growth_depth_m);
  x[at(JointTerm::added_mass)] = cone_.added_mass_gradient_kg_per_m(s.depth_m) * s.speed_mps * s.speed_mps +
                                 cone_.added_mass_kg(s.depth_m) * s.accel_mps2;
  x[at(JointTerm::surface)] = 1.0;
  x[at(JointTerm::drift)] = s.since_contact_s;
  x[at(JointTerm::friction)] = std::tanh(s.leg_rate_mps / config_.friction_switch_speed_mps);
  for (std::size_t i = 0; i < kJointTerms; ++i) {
    for (std::size_t j = 0; j < kJointTerms; ++j) sums_.normal[kJointTerms * i + j] += weight * x[i] * x[j];
    sums_.moment[i] += weight * x[i] * s.force_N;
  }
  sums_.force_squared += weight * s.force_N * s.force_N;
  sums_.observations += share;
  sums_.depth_min_m = sums_.samples == 0 ? s.depth_m : std::min(sums_.depth_min_m, s.depth_m);
  sums_.depth_max_m = std::max(sums_.depth_max_m, s.depth_m);
  ++sums_.samples;
}

namespace {

struct Prior {
  Vector mean;
  Vector precision;
};

// The priors of lengths and speeds are multiplied by the stiffness, because the equations contain forces.
Prior prior_at(const JointConfig& c, double stiffness_N_per_m) {
  const double k = stiffness_N_per_m;
  Prior prior{Vector::Zero(), Vector::Zero()};
  const auto set = [&](JointTerm term, double mean, double sd) {
    prior.mean[at(term)] = mean;
    prior.precision[at(term)] = 1.0 / (sd * sd);
  };
  set(JointTerm::intercept, k * c.intercept_depth_m, k * c.intercept_depth_sd_m);
  set(JointTerm::added_mass, c.added_mass_factor, c.added_mass_factor_sd);
  set(JointTerm::surface, 0.0, k * c.surface_sd_m);
  set(JointTerm::drift, 0.0, k * c.depth_drift_sd_mps);
  set(JointTerm::friction, 0.0, c.joint_friction_sd_N);
  return prior;
}

struct Solution {
  Vector value;
  Matrix covariance;
};

// Inverse of a positive definite matrix by Gauss-Jordan elimination in plain loops. Eigen's inverse sums in
// an order that depends on the processor, and a replay of a log must give the same bits on every processor.
Matrix inverse_of(Matrix m) {
  for (Eigen::Index k = 0; k < m.rows(); ++k) {
    const double pivot = m(k, k);
    m(k, k) = 1.0;
    for (Eigen::Index j = 0; j < m.cols(); ++j) m(k, j) /= pivot;
    for (Eigen::Index i = 0; i < m.rows(); ++i) {
      if (i == k) continue;
      const double factor = m(i, k);
      m(i, k) = 0.0;
      for (Eigen::Index j = 0; j < m.cols(); ++j) m(i, j) -= factor * m(k, j);
    }
  }
  return m;
}

// A term that must not be negative and comes out negative is set to zero.
Solution solve_with(const Matrix& normal, const Vector& moment, Prior prior) {
  constexpr double kHeld = 1e12;
  Solution solution;
  for (int pass = 0; pass < 3; ++pass) {
    const Matrix information = normal + Matrix(prior.precision.asDiagonal());
    solution.covariance = inverse_of(information);
    solution.value = solution.covariance * (moment + prior.precision.cwiseProduct(prior.mean));
    bool feasible = true;
    for (const auto term : {JointTerm::intercept, JointTerm::added_mass}) {
      if (solution.value[at(term)] >= -1e-6) continue;
      prior.mean[at(term)] = 0.0;
      prior.precision[at(term)] = kHeld;
      feasible = false;
    }
    if (feasible) break;
  }
  return solution;
}

Validity refuse(const JointSums& sums, const StiffnessConfig& config) {
  if (sums.samples == 0) return sums.saturated > 0 ? Validity::saturated : Validity::no_new_penetration;
  if (sums.observations < config.joint.min_observations) return Validity::too_few_samples;
  if (sums.depth_max_m - sums.depth_min_m < config.min_depth_span_m) return Validity::too_shallow;
  return Validity::valid;
}

Validity judge(const JointSums& sums, const StiffnessConfig& config, const JointEstimate& e) {
  if (!std::isfinite(e.ci95_low_N_per_m) || !std::isfinite(e.ci95_high_N_per_m))
    return Validity::interval_unbounded;
  if (!(e.value_N_per_m > 0.0)) return Validity::not_positive;
  if (!(e.ci95_low_N_per_m > 0.0)) return Validity::interval_includes_zero;
  if (sums.depth_max_m > config.max_depth_m) return Validity::deeper_than_foot;
  if (sums.saturated > 0) return Validity::saturated;
  return Validity::valid;
}

}  // namespace

JointEstimate solve_joint(const JointSums& sums, const StiffnessConfig& config) noexcept {
  JointEstimate e;
  e.samples = sums.samples;
  e.observations = sums.observations;
  e.validity = refuse(sums, config);
  if (e.validity != Validity::valid) return e;

  const Matrix normal = Eigen::Map<const Matrix>(sums.normal.data());
  const Vector moment = Eigen::Map<const Vector>(sums.moment.data());
  double k = moment[0] / normal(0, 0);
  Solution solution;
  for (int pass = 0; pass < 5; ++pass) {
    solution = solve_with(normal, moment, prior_at(config.joint, std::max(k, 1.0)));
    k = solution.value[0];
  }
  const Vector& b = solution.value;
  const double residual = sums.force_squared - 2.0 * b.dot(moment) + b.dot(normal * b);
  const double degrees = std::max(sums.observations - 3.0, 1.0);
  e.chi_squared = std::max(residual, 0.0) / degrees;
  const double scatter = std::max(e.chi_squared, 1.0);
  const double scale_sd = config.joint.force_scale_relative * k;
  e.value_N_per_m = k;
  e.standard_error_N_per_m = std::sqrt(scatter * solution.covariance(0, 0) + scale_sd * scale_sd);
  const double half = student_975(degrees) * e.standard_error_N_per_m;
  e.ci95_low_N_per_m = k - half;
  e.ci95_high_N_per_m = k + half;
  e.intercept_depth_m = b[at(JointTerm::intercept)] / k;
  e.added_mass_factor = b[at(JointTerm::added_mass)];
  e.added_mass_factor_sd =
      std::sqrt(scatter * solution.covariance(at(JointTerm::added_mass), at(JointTerm::added_mass)));
  e.depth_drift_mps = b[at(JointTerm::drift)] / k;
  e.joint_friction_N = b[at(JointTerm::friction)];
  e.validity = judge(sums, config, e);
  return e;
}

PooledStiffness pool_strides(std::span<const JointEstimate> strides, const JointConfig& config) {
  double w = 0.0, wk = 0.0, wkk = 0.0, ww = 0.0;
  PooledStiffness pooled;
  // The force-scale error is common to all strides. Remove it from each variance here and add it again at the
  // end.
  const auto own_variance = [&](const JointEstimate& e) {
    const double scale = config.force_scale_relative * e.value_N_per_m;
    const double se = e.standard_error_N_per_m;
    return std::max(se * se - scale * scale, 1e-6 * se * se);
  };
  for (const auto& e : strides) {
    if (e.validity != Validity::valid) continue;
    const double weight = 1.0 / own_variance(e);
    w += weight;
    wk += weight * e.value_N_per_m;
    wkk += weight * e.value_N_per_m * e.value_N_per_m;
    ww += weight * weight;
    ++pooled.strides;
  }
  if (pooled.strides == 0) return pooled;
  const double n = pooled.strides;
  const double spread = wkk - wk * wk / w;
  const double between = n > 1.0 ? std::max(0.0, (spread - (n - 1.0)) / (w - ww / w)) : 0.0;
  double sum = 0.0, mean = 0.0;
  for (const auto& e : strides) {
    if (e.validity != Validity::valid) continue;
    const double weight = 1.0 / (own_variance(e) + between);
    sum += weight;
    mean += weight * e.value_N_per_m;
  }
  mean /= sum;
  const double scale = config.force_scale_relative * mean;
  const double own = student_975(std::max(n - 1.0, 1.0)) * std::sqrt(1.0 / sum);
  const double half = std::sqrt(own * own + 1.96 * 1.96 * scale * scale);
  pooled.value_N_per_m = mean;
  pooled.ci95_low_N_per_m = mean - half;
  pooled.ci95_high_N_per_m = mean + half;
  pooled.between_strides_sd_N_per_m = std::sqrt(between);
  return pooled;
}

double student_975(double degrees) noexcept {
  const double z = 1.959964;
  const double n = std::max(degrees, 1.0);
  if (n < 1.5) return 12.706;
  if (n < 2.5) return 4.303;
  const double z3 = z * z * z, z5 = z3 * z * z, z7 = z5 * z * z;
  return z + (z3 + z) / (4.0 * n) + (5.0 * z5 + 16.0 * z3 + 3.0 * z) / (96.0 * n * n) +
         (3.0 * z7 + 19.0 * z5 + 17.0 * z3 - 15.0 * z) / (384.0 * n * n * n);
}

}  // namespace sandhopper
