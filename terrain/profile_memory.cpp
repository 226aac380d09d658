#include <algorithm>
#include <array>
#include <cmath>

#include "terrain/strength_profile.hpp"

// Information kept from one stride of a trial to the next, and the errors of the depth.
namespace sandhopper {

void ProfileSolver::add_kept(Information& info) const noexcept {
  for (std::size_t i = 0; i < info.normal.size(); ++i) info.normal[i] += kept_normal_[i];
  for (std::size_t i = 0; i < kTerms; ++i) info.moment[i] += kept_moment_[i];
}

// The friction belongs to this stride alone (Schur complement). Every change of a moment changes in the same
// way.
void ProfileSolver::integrate_friction(Information& info) const noexcept {
  const double friction_sd = config_.joint.joint_friction_sd_N;
  info.friction_normal += 1.0 / (friction_sd * friction_sd);
  for (std::size_t i = 0; i < kTerms; ++i) {
    const double gain = info.with_friction[i] / info.friction_normal;
    info.moment[i] -= gain * info.friction_moment;
    for (std::size_t j = 0; j < kTerms; ++j) info.normal[i * kTerms + j] -= gain * info.with_friction[j];
    for (std::size_t s = 0; s < kProfileCells; ++s) info.of_depth[s][i] -= gain * info.friction_of_depth[s];
  }
}

void ProfileSolver::take_friction(const Information& info) noexcept {
  double moment = info.friction_moment;
  for (std::size_t i = 0; i < kTerms; ++i) moment -= info.with_friction[i] * posterior_.mean[i];
  friction_N_ = moment / info.friction_normal;
}

// Change of the moment if every sample of a cell increases by one newton. The last line is the depth's
// column, as in `depend_on_contact`.
void ProfileSolver::take_responses(const ProfileSums& sums, const Information& info) noexcept {
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
    response[kSteadyDrag] += sum(F::steady_drag);
    const double friction = sum(F::friction) / info.friction_normal, depth = slope_N_per_m_[s] * sum(F::one);
    for (std::size_t i = 0; i < kTerms; ++i)
      response[i] += depth * begins_of_[i] - friction * info.with_friction[i];
  }
}

// Mean and variance of D before the samples of a stride in a crater: those of the crater's depth, and the
// landing's own variance. On new ground they follow from the curve (`expect_contact`).
void ProfileSolver::begin_depth_errors(bool in_crater) noexcept {
  if (in_crater) {
    begins_m_ = kept_errors_.mean_m;
    begins_of_ = {};
    kept_errors_.variance_m2 += prior_.landing_depth_sd_m * prior_.landing_depth_sd_m;
    return;
  }
  kept_errors_.with_depth = {};
  kept_errors_.of_earlier_surface = kept_errors_.of_surface;
}

// The mean of D is that of the previous posterior. To first order, a sample is F(z + D) with D plus the
// terms' change times `begins_of_`, so every column of the fit has that part of the depth's column.
void ProfileSolver::depend_on_contact(Information& info) const noexcept {
  Vector<kTerms> of_begin{};
  double normal = 0.0, moment = 0.0, friction = 0.0, previous_m = 0.0;
  for (std::size_t s = 0; s < kProfileCells; ++s) {
    normal += info.depth_normal[s];
    moment += info.depth_moment[s];
    friction += info.friction_of_depth[s];
    for (std::size_t i = 0; i < kTerms; ++i) of_begin[i] += info.of_depth[s][i];
  }
  const auto& of = begins_of_;
  for (std::size_t i = 0; i < kTerms; ++i) {
    previous_m += of[i] * posterior_.mean[i];
    info.moment[i] += of[i] * moment;
    info.with_friction[i] += of[i] * friction;
    for (std::size_t j = 0; j < kTerms; ++j)
      info.normal[i * kTerms + j] += of_begin[i] * of[j] + of[i] * (of_begin[j] + normal * of[j]);
    for (std::size_t s = 0; s < kProfileCells; ++s) info.of_depth[s][i] += of[i] * info.depth_normal[s];
  }
  Vector<kProfileCells> mean_m;
  mean_m.fill(-previous_m);
  subtract_depth_error(info, mean_m);
}

double ProfileSolver::mean_depth_error_m(double change_mps) const noexcept {
  return begins_m_ + prior_.depth_lag_s * change_mps;
}

void ProfileSolver::subtract_depth_error(Information& info, const Vector<kProfileCells>& mean_m) noexcept {
  for (std::size_t s = 0; s < kProfileCells; ++s) {
    for (std::size_t i = 0; i < kTerms; ++i) info.moment[i] -= mean_m[s] * info.of_depth[s][i];
    info.depth_moment[s] -= mean_m[s] * info.depth_normal[s];
    info.friction_moment -= mean_m[s] * info.friction_of_depth[s];
  }
}

void ProfileSolver::subtract_mean_depth_error(Information& info) const noexcept {
  Vector<kProfileCells> mean_m;
  for (std::size_t s = 0; s < kProfileCells; ++s) mean_m[s] = mean_depth_error_m(info.change_mps[s]);
  subtract_depth_error(info, mean_m);
}

// Covariance of D at two times, each with the change of speed since contact.
double ProfileSolver::depth_covariance_m2(double time_s, double change_mps, double other_s,
                                          double other_mps) const noexcept {
  const auto correlation = [&](double from_s, double to_s) {
    const double phase = prior_.filter_decay_per_s * std::abs(to_s - from_s);
    return std::exp(-phase) * std::cos(phase);
  };
  const double filter_m2 = prior_.filter_sd_m * prior_.filter_sd_m;
  const double lag_s2 = prior_.depth_lag_sd_s * prior_.depth_lag_sd_s;
  return kept_errors_.variance_m2 + lag_s2 * change_mps * other_mps +
         filter_m2 *
             (1.0 + correlation(time_s, other_s) - correlation(0.0, time_s) - correlation(0.0, other_s));
}

ProfileSolver::Matrix<kProfileCells> ProfileSolver::depth_covariance(const Information& info) const noexcept {
  Matrix<kProfileCells> covariance{};
  for (std::size_t s = 0; s < kProfileCells; ++s)
    for (std::size_t t = 0; t <= s; ++t)
      if (info.depth_normal[s] > 0.0 && info.depth_normal[t] > 0.0)
        covariance[s * kProfileCells + t] = covariance[t * kProfileCells + s] =
            depth_covariance_m2(info.time_s[s], info.change_mps[s], info.time_s[t], info.change_mps[t]);
  return covariance;
}

// Mean square of D about its mean over a cell. For a random walk of this growth during the time T it is
// growth * T / 6. Times that are uniform over T have the standard deviation T / root 12.
double ProfileSolver::wander_m2(const ProfileCell& cell) const noexcept {
  using F = ProfileFeature;
  const double sum = cell.product(F::one, F::one), mean_s = cell.product(F::one, F::time) / sum;
  const double variance_s2 = std::max(cell.product(F::time, F::time) / sum - mean_s * mean_s, 0.0);
  const double growth_m2_per_s = 2.0 * prior_.filter_decay_per_s * prior_.filter_sd_m * prior_.filter_sd_m;
  return growth_m2_per_s * std::sqrt(12.0 * variance_s2) / 6.0;
}

// Adds the covariance of this stride's part of the moments. Its d has a covariance with those of the strides
// before, and shares a part with those of other places; l is the same in all; x is independent of
// everything.
void ProfileSolver::take_depth_errors(const Information& info) noexcept {
  errors_ = kept_errors_;
  const auto& with = kept_errors_.with_depth;
  const auto covariance = depth_covariance(info);
  const double surface_m2 = prior_.shared_surface_sd_m * prior_.shared_surface_sd_m;
  const double lag_s2 = prior_.depth_lag_sd_s * prior_.depth_lag_sd_s;
  const auto& surface_before = kept_errors_.of_earlier_surface;
  const auto& lag_before = kept_errors_.of_lag;
  Vector<kTerms> all{}, lag{};  // change of the moment for a unit of d, and of l
  for (std::size_t s = 0; s < kProfileCells; ++s) {
    if (info.depth_normal[s] == 0.0) continue;
    Vector<kTerms> row{};  // covariance of the moment's change and D of this cell
    for (std::size_t t = 0; t < kProfileCells; ++t)
      for (std::size_t i = 0; i < kTerms; ++i)
        row[i] += covariance[s * kProfileCells + t] * info.of_depth[t][i];
    for (std::size_t i = 0; i < kTerms; ++i) {
      all[i] += info.of_depth[s][i];
      lag[i] += info.change_mps[s] * info.of_depth[s][i];
      for (std::size_t j = 0; j < kTerms; ++j) errors_.moment[i * kTerms + j] += info.of_depth[s][i] * row[j];
    }
  }
  for (std::size_t i = 0; i < kTerms; ++i)
    for (std::size_t j = 0; j < kTerms; ++j)
      errors_.moment[i * kTerms + j] +=
          with[i] * all[j] + all[i] * with[j] +
          surface_m2 * (surface_before[i] * all[j] + all[i] * surface_before[j]) +
          lag_s2 * (lag_before[i] * lag[j] + lag[i] * lag_before[j]);
  for (std::size_t i = 0; i < kTerms; ++i) {
    errors_.of_surface[i] += all[i];
    errors_.of_lag[i] += lag[i];
  }
}

// Covariance with D at the deepest point, where the next stride begins.
void ProfileSolver::end_depth_errors(const Information& info, const ProfileSums& sums) noexcept {
  const double t = sums.last_s, v = sums.last_change_mps;
  for (std::size_t s = 0; s < kProfileCells; ++s) {
    if (info.depth_normal[s] == 0.0) continue;
    const double covariance_m2 = depth_covariance_m2(info.time_s[s], info.change_mps[s], t, v);
    for (std::size_t i = 0; i < kTerms; ++i) errors_.with_depth[i] += covariance_m2 * info.of_depth[s][i];
  }
  errors_.mean_m = mean_depth_error_m(v);
  errors_.variance_m2 = depth_covariance_m2(t, v, t, v);
}

void ProfileSolver::keep(const Information& info) noexcept {
  kept_normal_ = info.normal;
  kept_moment_ = info.moment;
  kept_errors_ = errors_;
  kept_place_ = place_;
  kept_strength_ = strength_;
}

}  // namespace sandhopper
