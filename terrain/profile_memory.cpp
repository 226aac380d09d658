#include <algorithm>
#include <array>

#include "terrain/small_gaussian.hpp"
#include "terrain/strength_profile.hpp"

// Information kept from one stride of a trial to the next, and the errors of the depth.
namespace sandhopper {

void ProfileSolver::add_stride_prior(Information& info) const noexcept {
  const double friction_sd = config_.joint.joint_friction_sd_N;
  info.normal[kFriction * kTerms + kFriction] += 1.0 / (friction_sd * friction_sd);
  for (std::size_t i = 0; i < info.normal.size(); ++i) info.normal[i] += kept_normal_[i];
  for (std::size_t i = 0; i < kTerms; ++i) info.moment[i] += kept_moment_[i];
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
    response[kFriction] += sum(F::friction);
  }
}

// Variance of d before the samples of a stride: on new ground that of a surface, in a crater that of the
// crater's depth plus that of the landing.
void ProfileSolver::begin_depth_errors(bool in_crater) noexcept {
  const double sd_m = in_crater ? prior_.landing_depth_sd_m : prior_.surface_sd_m;
  if (!in_crater) {
    kept_errors_.with_depth = {};
    kept_errors_.variance_m2 = 0.0;
  }
  kept_errors_.variance_m2 += sd_m * sd_m;
}

// Adds the covariance of this stride's part of the moments. Its d has a covariance with those of the strides
// before; r and l are independent of everything.
void ProfileSolver::take_depth_errors(const Information& info) noexcept {
  const double drift_sd = config_.joint.depth_drift_sd_mps, lag_sd = prior_.depth_lag_sd_s;
  const std::array<double, kDepthErrors> variance{kept_errors_.variance_m2, drift_sd * drift_sd,
                                                  lag_sd * lag_sd};
  errors_ = kept_errors_;
  const auto& d = info.of_depth[0];
  const auto& with = kept_errors_.with_depth;
  for (std::size_t i = 0; i < kTerms; ++i)
    for (std::size_t j = 0; j < kTerms; ++j) {
      double& sum = errors_.moment[i * kTerms + j];
      sum += with[i] * d[j] + d[i] * with[j];
      for (std::size_t e = 0; e < kDepthErrors; ++e)
        sum += variance[e] * info.of_depth[e][i] * info.of_depth[e][j];
    }
}

// D at the deepest point is d + r T + l V, T the time from contact and V the change of speed.
void ProfileSolver::end_depth_errors(const Information& info, const ProfileSums& sums) noexcept {
  const double drift_sd = config_.joint.depth_drift_sd_mps, lag_sd = prior_.depth_lag_sd_s;
  const double drift_m2_per_s = sums.last_s * drift_sd * drift_sd;
  const double lag_m_s = sums.last_change_mps * lag_sd * lag_sd;
  for (std::size_t i = 0; i < kTerms; ++i)
    errors_.with_depth[i] += kept_errors_.variance_m2 * info.of_depth[0][i] +
                             drift_m2_per_s * info.of_depth[1][i] + lag_m_s * info.of_depth[2][i];
  errors_.variance_m2 += drift_m2_per_s * sums.last_s + lag_m_s * sums.last_change_mps;
}

// Keeps the information and integrates out the friction, which belongs to this stride alone (Schur
// complement). Every change of a moment changes in the same way.
void ProfileSolver::keep(const Information& info) noexcept {
  Vector<kTerms> gain{};
  for (std::size_t i = 0; i < kShared; ++i)
    gain[i] = info.normal[i * kTerms + kFriction] / info.normal[kFriction * kTerms + kFriction];
  const auto reduce = [&](Vector<kTerms>& change) {
    for (std::size_t i = 0; i < kShared; ++i) change[i] -= gain[i] * change[kFriction];
    change[kFriction] = 0.0;
  };
  kept_moment_ = info.moment;
  reduce(kept_moment_);
  for (std::size_t i = 0; i < kTerms; ++i)
    for (std::size_t j = 0; j < kTerms; ++j)
      kept_normal_[i * kTerms + j] =
          i == kFriction || j == kFriction
              ? 0.0
              : info.normal[i * kTerms + j] - gain[i] * info.normal[kFriction * kTerms + j];
  for (Vector<kTerms>& response : response_) reduce(response);
  reduce(errors_.with_depth);
  for (int side = 0; side < 2; ++side)  // rows, then, after the transposition, columns
    for (std::size_t i = 0; i < kTerms; ++i) {
      Vector<kTerms> row;
      for (std::size_t j = 0; j < kTerms; ++j) row[j] = errors_.moment[i * kTerms + j];
      reduce(row);
      for (std::size_t j = 0; j < kTerms; ++j) errors_.moment[i * kTerms + j] = row[j];
      if (i + 1 < kTerms) continue;
      for (std::size_t a = 0; a < kTerms; ++a)
        for (std::size_t b = 0; b < a; ++b)
          std::swap(errors_.moment[a * kTerms + b], errors_.moment[b * kTerms + a]);
    }
  kept_errors_ = errors_;
}

// Information of a stride on kappa, c, e and b, without their prior, with d, r, l and f integrated out. That
// a stride begins with the depth error of its crater is left out.
void ProfileSolver::share(const Information& own) noexcept {
  constexpr std::size_t kOwn = kDepthErrors + 1;
  const double drift_sd = config_.joint.depth_drift_sd_mps, lag_sd = prior_.depth_lag_sd_s;
  const double friction_sd = config_.joint.joint_friction_sd_N;
  const std::array<double, kOwn> variance{kept_errors_.variance_m2, drift_sd * drift_sd, lag_sd * lag_sd,
                                          friction_sd * friction_sd};
  const auto row = [&](std::size_t term) {
    Vector<kOwn> values;
    for (std::size_t e = 0; e < kDepthErrors; ++e) values[e] = own.of_depth[e][term];
    values[kDepthErrors] = own.normal[term * kTerms + kFriction];
    return values;
  };
  Matrix<kOwn> normal{};
  Vector<kOwn> moment{};
  const auto friction = row(kFriction);
  for (std::size_t a = 0; a < kOwn; ++a) {
    for (std::size_t b = 0; b < kOwn; ++b)
      normal[a * kOwn + b] = a == kDepthErrors   ? friction[b]
                             : b == kDepthErrors ? friction[a]
                                                 : own.depth_normal[a * kDepthErrors + b];
    normal[a * kOwn + a] += 1.0 / variance[a];
    moment[a] = a == kDepthErrors ? own.moment[kFriction] : own.depth_moment[a];
  }
  const Cholesky<kOwn> root(normal);
  for (std::size_t i = 0; i < kShared; ++i) {
    const auto gain = root.solve(row(i));
    shared_moment_[i] += own.moment[i];
    for (std::size_t a = 0; a < kOwn; ++a) shared_moment_[i] -= gain[a] * moment[a];
    for (std::size_t j = 0; j < kShared; ++j) {
      double& value = shared_normal_[i * kShared + j];
      value += own.normal[i * kTerms + j];
      const auto other = row(j);
      for (std::size_t a = 0; a < kOwn; ++a) value -= gain[a] * other[a];
    }
  }
}

}  // namespace sandhopper
