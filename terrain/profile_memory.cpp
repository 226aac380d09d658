#include <algorithm>
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

// Replaces d by D = d + r T + l V and integrates out the terms of this stride alone (Schur complement).
void ProfileSolver::keep(Information info) noexcept {
  constexpr std::size_t kOwn = kTerms - kKept;
  for (std::size_t a = 0; a < kOwn; ++a) {
    const std::size_t own = kKept + a;
    for (std::size_t i = 0; i < kTerms; ++i)
      info.normal[i * kTerms + own] -= of_deepest_[a] * info.normal[i * kTerms + kSurface];
    for (std::size_t j = 0; j < kTerms; ++j)
      info.normal[own * kTerms + j] -= of_deepest_[a] * info.normal[kSurface * kTerms + j];
    info.moment[own] -= of_deepest_[a] * info.moment[kSurface];
  }
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
    for (std::size_t a = 0; a < kTerms - kKept; ++a)
      response[kKept + a] -= of_deepest_[a] * response[kSurface];
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

// Distribution of d, r and l before the samples of a stride.
void ProfileSolver::expect_depth(bool in_crater) noexcept {
  const double sd_m = in_crater ? prior_.landing_depth_sd_m : prior_.surface_sd_m;
  in_crater_ = in_crater;
  if (!in_crater) depth_m_ = depth_variance_m2_ = 0.0;
  depth_variance_m2_ += sd_m * sd_m;
  held_mean_ = {depth_m_, 0.0, 0.0};
  const double drift_sd = config_.joint.depth_drift_sd_mps, lag_sd = prior_.depth_lag_sd_s;
  held_variance_ = {depth_variance_m2_, drift_sd * drift_sd, lag_sd * lag_sd};
}

// Distribution of D after them.
void ProfileSolver::take_depth() noexcept {
  Vector<kTerms> x{};
  x[kSurface] = 1.0;
  std::copy(of_deepest_.begin(), of_deepest_.end(), x.begin() + kKept);
  depth_m_ = depth_variance_m2_ = 0.0;
  for (std::size_t i = kSurface; i < kTerms; ++i) {
    depth_m_ += x[i] * posterior_.mean[i];
    for (std::size_t j = kSurface; j < kTerms; ++j)
      depth_variance_m2_ += x[i] * x[j] * posterior_.covariance[i * kTerms + j];
  }
}

// Change of every term for a unit change of d, r and l: C_D C_DD^-1, C_D the columns of the covariance for
// them, C_DD their own block.
ProfileSolver::DepthGains ProfileSolver::depth_gains(const DepthGains& columns) const noexcept {
  Matrix<kHeld> own;
  for (std::size_t a = 0; a < kHeld; ++a)
    for (std::size_t b = 0; b < kHeld; ++b) own[a * kHeld + b] = columns[b][kSurface + a];
  const Cholesky<kHeld> root(own);
  DepthGains gains;
  for (std::size_t i = 0; i < kTerms; ++i) {
    Vector<kHeld> row;
    for (std::size_t a = 0; a < kHeld; ++a) row[a] = columns[a][i];
    row = root.solve(row);
    for (std::size_t a = 0; a < kHeld; ++a) gains[a][i] = row[a];
  }
  return gains;
}

// Moves d, r and l to their means before the stride, and every other term with them.
void ProfileSolver::hold_depth(const Cholesky<kTerms>& root, Vector<kTerms>& mean) const noexcept {
  DepthGains columns{};
  for (std::size_t a = 0; a < kHeld; ++a) {
    columns[a][kSurface + a] = 1.0;
    columns[a] = root.solve(columns[a]);
  }
  const DepthGains gains = depth_gains(columns);
  Vector<kHeld> change;
  for (std::size_t a = 0; a < kHeld; ++a) change[a] = mean[kSurface + a] - held_mean_[a];
  for (std::size_t a = 0; a < kHeld; ++a)
    for (std::size_t i = 0; i < kTerms; ++i) mean[i] -= gains[a][i] * change[a];
}

// Gives d, r and l the covariance P that they had before the stride: C + G (P - C_DD) G^T.
void ProfileSolver::hold_depth(Matrix<kTerms>& covariance) const noexcept {
  if (!in_crater_) return;
  DepthGains columns;
  for (std::size_t a = 0; a < kHeld; ++a)
    for (std::size_t i = 0; i < kTerms; ++i) columns[a][i] = covariance[i * kTerms + kSurface + a];
  const DepthGains gains = depth_gains(columns);
  for (std::size_t i = 0; i < kTerms; ++i) {
    Vector<kHeld> with{};
    for (std::size_t a = 0; a < kHeld; ++a)
      for (std::size_t b = 0; b < kHeld; ++b)
        with[b] += gains[a][i] * ((a == b ? held_variance_[a] : 0.0) - columns[b][kSurface + a]);
    for (std::size_t j = 0; j < kTerms; ++j)
      for (std::size_t b = 0; b < kHeld; ++b) covariance[i * kTerms + j] += with[b] * gains[b][j];
  }
}

}  // namespace sandhopper
