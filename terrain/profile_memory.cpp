#include <array>
#include <utility>

#include "terrain/small_gaussian.hpp"
#include "terrain/strength_profile.hpp"

// Information kept from one stride of a trial to the next, and the depth error that a landing adds.
namespace sandhopper {

void ProfileSolver::add_stride_prior(Information& info) const noexcept {
  const auto& joint = config_.joint;
  const std::array<std::pair<std::size_t, double>, 3> priors{{{kDrift, joint.depth_drift_sd_mps},
                                                              {kLag, prior_.depth_lag_sd_s},
                                                              {kFriction, joint.joint_friction_sd_N}}};
  for (const auto& [term, sd] : priors) info.normal[term * kTerms + term] += 1.0 / (sd * sd);
  for (std::size_t i = 0; i < kKept; ++i) {
    info.moment[i] += kept_moment_[i];
    for (std::size_t j = 0; j < kKept; ++j) info.normal[i * kTerms + j] += kept_normal_[i * kKept + j];
  }
}

// Change of the moment if every sample of a cell increases by one newton.
void ProfileSolver::take_responses(const ProfileSums& sums) noexcept {
  using F = ProfileFeature;
  for (std::size_t s = 0; s < kProfileCells; ++s) {
    auto& response = response_[s];
    const double weight = 1.0 / noise_factor_[s];
    const auto sum = [&](F feature) { return weight * sums.cells[s].product(F::one, feature); };
    for (std::size_t i = 0; i < s; ++i) response[i] += kProfileCell_m * sum(F::one);
    response[s] += kProfileCell_m * sum(F::place);
    response[kAddedMass] += sum(F::added_mass);
    response[kScale] += sum(F::motor);
    response[kIntercept] += prior_.believed_stiffness_N_per_m * sum(F::intercept);
    response[kSurface] += slope_N_per_m_[s] * sum(F::one);
    response[kDrift] += slope_N_per_m_[s] * sum(F::time);
    response[kLag] += slope_N_per_m_[s] * sum(F::speed);
    response[kFriction] += sum(F::friction);
  }
}

// Replaces d by D = d + r T and integrates out the terms of this stride alone (Schur complement).
void ProfileSolver::keep(Information info, double last_s) noexcept {
  last_s_ = last_s;
  for (std::size_t i = 0; i < kTerms; ++i)
    info.normal[i * kTerms + kDrift] -= last_s * info.normal[i * kTerms + kSurface];
  for (std::size_t j = 0; j < kTerms; ++j)
    info.normal[kDrift * kTerms + j] -= last_s * info.normal[kSurface * kTerms + j];
  info.moment[kDrift] -= last_s * info.moment[kSurface];
  constexpr std::size_t kOwn = kTerms - kKept;
  Matrix<kOwn> own{};
  for (std::size_t i = 0; i < kOwn; ++i)
    for (std::size_t j = 0; j < kOwn; ++j) own[i * kOwn + j] = info.normal[(kKept + i) * kTerms + kKept + j];
  const Matrix<kOwn> inverse = Cholesky<kOwn>(own).inverse();
  for (std::size_t i = 0; i < kKept; ++i) {
    Vector<kOwn>& gain = own_gain_[i];
    gain = {};
    for (std::size_t a = 0; a < kOwn; ++a)
      for (std::size_t b = 0; b < kOwn; ++b)
        gain[a] += info.normal[i * kTerms + kKept + b] * inverse[b * kOwn + a];
    kept_moment_[i] = info.moment[i];
    for (std::size_t a = 0; a < kOwn; ++a) kept_moment_[i] -= gain[a] * info.moment[kKept + a];
    for (std::size_t j = 0; j < kKept; ++j) {
      double value = info.normal[i * kTerms + j];
      for (std::size_t a = 0; a < kOwn; ++a) value -= gain[a] * info.normal[(kKept + a) * kTerms + j];
      kept_normal_[i * kKept + j] = value;
    }
  }
  static_assert(kSurface == kShared && kShared + 1 == kKept);
  const auto kept = [&](std::size_t i, std::size_t j) { return kept_normal_[i * kKept + j]; };
  for (std::size_t i = 0; i < kShared; ++i) {
    const double gain = kept(i, kSurface) / kept(kSurface, kSurface);
    shared_moment_[i] = kept_moment_[i] - gain * kept_moment_[kSurface];
    for (std::size_t j = 0; j < kShared; ++j)
      shared_normal_[i * kShared + j] = kept(i, j) - gain * kept(kSurface, j);
  }
}

// Transition from D of the previous strides to d = D + N(0, landing^2) of the next. Let A be the information
// on D alone. Integrating D out subtracts q times the products of its row from the kept information, with q =
// landing^2 / (1 + A landing^2). The responses are moments and change in the same way.
void ProfileSolver::land(double landing_m) noexcept {
  const double variance = landing_m * landing_m;
  const double q = variance / (1.0 + kept_normal_[kSurface * kKept + kSurface] * variance);
  Vector<kKept> row{};
  for (std::size_t i = 0; i < kKept; ++i) row[i] = kept_normal_[i * kKept + kSurface];
  for (Vector<kTerms>& response : response_) {
    response[kDrift] -= last_s_ * response[kSurface];
    for (std::size_t i = 0; i < kKept; ++i)
      for (std::size_t a = 0; a < kTerms - kKept; ++a) response[i] -= own_gain_[i][a] * response[kKept + a];
    const double of_depth = response[kSurface];
    for (std::size_t i = 0; i < kKept; ++i) response[i] -= q * row[i] * of_depth;
    for (std::size_t i = kKept; i < kTerms; ++i) response[i] = 0.0;
  }
  const double of_depth = kept_moment_[kSurface];
  for (std::size_t i = 0; i < kKept; ++i) {
    kept_moment_[i] -= q * row[i] * of_depth;
    for (std::size_t j = 0; j < kKept; ++j) kept_normal_[i * kKept + j] -= q * row[i] * row[j];
  }
}

// Distribution of d before the samples of a stride.
void ProfileSolver::expect_depth(bool in_crater) noexcept {
  const double sd_m = in_crater ? prior_.landing_depth_sd_m : config_.joint.surface_sd_m;
  in_crater_ = in_crater;
  if (!in_crater) depth_m_ = depth_variance_m2_ = 0.0;
  depth_variance_m2_ += sd_m * sd_m;
}

// Distribution of D after them.
void ProfileSolver::take_depth(double last_s) noexcept {
  const auto& c = posterior_.covariance;
  depth_m_ = posterior_.mean[kSurface] + last_s * posterior_.mean[kDrift];
  depth_variance_m2_ = c[kSurface * kTerms + kSurface] + 2.0 * last_s * c[kSurface * kTerms + kDrift] +
                       last_s * last_s * c[kDrift * kTerms + kDrift];
}

// Change of every term for a unit change of d and of r: C_D C_DD^-1, C_D the columns of the covariance for d
// and r, C_DD their own 2 x 2 block.
ProfileSolver::DepthGains ProfileSolver::depth_gains(const Vector<kTerms>& of_depth,
                                                     const Vector<kTerms>& of_drift) const noexcept {
  const double a = of_depth[kSurface], b = of_depth[kDrift], c = of_drift[kDrift];
  const double scale = 1.0 / (a * c - b * b);
  DepthGains gains;
  for (std::size_t i = 0; i < kTerms; ++i) {
    gains[0][i] = scale * (c * of_depth[i] - b * of_drift[i]);
    gains[1][i] = scale * (a * of_drift[i] - b * of_depth[i]);
  }
  return gains;
}

// Moves d and r to their means before the stride, and every other term with them.
void ProfileSolver::hold_depth(const DepthGains& gains, Vector<kTerms>& mean) const noexcept {
  const double depth = mean[kSurface] - depth_m_, drift = mean[kDrift];
  for (std::size_t i = 0; i < kTerms; ++i) mean[i] -= gains[0][i] * depth + gains[1][i] * drift;
}

// Gives d and r the covariance that they had before the stride: C + G (P - C_DD) G^T.
void ProfileSolver::hold_depth(Matrix<kTerms>& covariance) const noexcept {
  if (!in_crater_) return;
  Vector<kTerms> of_depth, of_drift;
  for (std::size_t i = 0; i < kTerms; ++i) {
    of_depth[i] = covariance[i * kTerms + kSurface];
    of_drift[i] = covariance[i * kTerms + kDrift];
  }
  const double drift_sd = config_.joint.depth_drift_sd_mps;
  const double depth = depth_variance_m2_ - of_depth[kSurface], both = -of_depth[kDrift];
  const double drift = drift_sd * drift_sd - of_drift[kDrift];
  const auto gains = depth_gains(of_depth, of_drift);
  for (std::size_t i = 0; i < kTerms; ++i) {
    const double with_depth = depth * gains[0][i] + both * gains[1][i];
    const double with_drift = both * gains[0][i] + drift * gains[1][i];
    for (std::size_t j = 0; j < kTerms; ++j)
      covariance[i * kTerms + j] += with_depth * gains[0][j] + with_drift * gains[1][j];
  }
}

}  // namespace sandhopper
