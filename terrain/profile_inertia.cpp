#include <algorithm>

#include "terrain/small_gaussian.hpp"
#include "terrain/strength_profile.hpp"

// Added mass, steady drag and the error of the force scale, from the comparison of strides at different
// speeds.
namespace sandhopper {

// Adds the information of a stride to that of its place, on all terms, with D of each cell and f integrated
// out. That a stride begins with the depth error of its crater is left out.
void ProfileSolver::add_between(const Information& own) noexcept {
  constexpr std::size_t kOwn = kProfileCells + 1;
  constexpr double kRounding_m2 = 1e-10;  // keeps the covariance of D positive definite
  const double friction_sd = config_.joint.joint_friction_sd_N;
  auto covariance = depth_covariance(own);
  for (std::size_t s = 0; s < kProfileCells; ++s) covariance[s * kProfileCells + s] += kRounding_m2;
  const auto precision = Cholesky<kProfileCells>(covariance).inverse();
  Matrix<kOwn> normal{};
  for (std::size_t s = 0; s < kProfileCells; ++s) {
    for (std::size_t t = 0; t < kProfileCells; ++t) normal[s * kOwn + t] = precision[s * kProfileCells + t];
    normal[s * kOwn + s] += own.depth_normal[s];
    normal[s * kOwn + kProfileCells] = normal[kProfileCells * kOwn + s] = own.friction_of_depth[s];
  }
  normal[kOwn * kOwn - 1] = own.friction_normal + 1.0 / (friction_sd * friction_sd);
  const Cholesky<kOwn> root(normal);
  // Changes of D's and f's own moments for a unit of each term, for the data, and for a unit of the shared
  // errors.
  const auto scaled = [&](const Vector<kProfileCells>& depth, double friction) {
    Vector<kOwn> values;
    for (std::size_t s = 0; s < kProfileCells; ++s) values[s] = depth[s];
    values[kProfileCells] = friction;
    return root.scaled(values);
  };
  std::array<Vector<kOwn>, kTerms> rows;
  Vector<kProfileCells> cells;
  for (std::size_t i = 0; i < kTerms; ++i) {
    for (std::size_t s = 0; s < kProfileCells; ++s) cells[s] = own.of_depth[s][i];
    rows[i] = scaled(cells, own.with_friction[i]);
  }
  const auto data = scaled(own.depth_moment, own.friction_moment);
  double friction_of_surface = 0.0, friction_of_lag = 0.0;
  for (std::size_t s = 0; s < kProfileCells; ++s) {
    cells[s] = own.depth_normal[s] * own.change_mps[s];
    friction_of_surface += own.friction_of_depth[s];
    friction_of_lag += own.friction_of_depth[s] * own.change_mps[s];
  }
  const auto surface = scaled(own.depth_normal, friction_of_surface), lag = scaled(cells, friction_of_lag);
  const auto less = [](double value, const Vector<kOwn>& a, const Vector<kOwn>& b) {
    for (std::size_t k = 0; k < kOwn; ++k) value -= a[k] * b[k];
    return value;
  };
  place_ = kept_place_;
  for (std::size_t i = 0; i < kTerms; ++i) {
    double of_surface = 0.0, of_lag = 0.0;
    for (std::size_t s = 0; s < kProfileCells; ++s) {
      of_surface += own.of_depth[s][i];
      of_lag += own.of_depth[s][i] * own.change_mps[s];
    }
    place_.moment[i] += less(own.moment[i], rows[i], data);
    place_.of_surface[i] += less(of_surface, rows[i], surface);
    place_.of_lag[i] += less(of_lag, rows[i], lag);
    for (std::size_t j = 0; j <= i; ++j) {
      const double value = less(own.normal[i * kTerms + j], rows[i], rows[j]);
      place_.normal[i * kTerms + j] += value;
      if (j < i) place_.normal[j * kTerms + i] += value;
    }
  }
}

// `info`: normal equations of the curve over all strides, without the prior.
void ProfileSolver::take_held(const Information& info) noexcept {
  Information prior;
  add_shared_prior(prior, posterior_.smoothness_m, posterior_.spread);
  // Strides of one set-up differ only by their errors. The prior of kappa, and of e, which scales it, counts
  // once for each place, so that repeating one set-up does not narrow c, lambda and e, and a shared error
  // does not grow.
  const auto of_curve = [](std::size_t term) { return term < kProfileCells || term == kScale; };
  const double places = std::max(places_, 1);
  auto normal = between_.normal;
  auto moment = between_.moment;
  for (std::size_t i = 0; i < kTerms; ++i) {
    moment[i] += prior.moment[i];
    for (std::size_t j = 0; j < kTerms; ++j)
      normal[i * kTerms + j] += prior.normal[i * kTerms + j] * (of_curve(i) ? places : 1.0);
  }
  const Cholesky<kTerms> root(normal);
  const auto mean = root.solve(moment);
  const double surface_m2 = prior_.shared_surface_sd_m * prior_.shared_surface_sd_m;
  const double lag_s2 = prior_.depth_lag_sd_s * prior_.depth_lag_sd_s;
  held_ = {.fitted = true};
  const auto shapes = place_shapes();
  std::array<Vector<kTerms>, kHeld.size()> column;
  for (std::size_t a = 0; a < kHeld.size(); ++a) {
    Vector<kTerms> unit{};
    unit[kHeld[a]] = 1.0;
    column[a] = root.solve(unit);
    held_.mean[a] = mean[kHeld[a]];
    for (std::size_t i = 0; i < kTerms; ++i) {
      held_.of_surface[a] += column[a][i] * between_.of_surface[i];
      held_.of_lag[a] += column[a][i] * between_.of_lag[i];
      for (std::size_t k = 0; k < kStrengths; ++k)
        for (std::size_t j = 0; j < kProfileCells; ++j)
          held_.of_strength[a][k] += column[a][i] * between_.normal[i * kTerms + j] * shapes[k][j];
    }
    for (std::size_t i = 0; i < kTerms; ++i) {
      if (held_.holds(i)) continue;
      held_.of_error[a][i] = info.normal[i * kTerms + kHeld[a]];
      double& with = held_.with_moment[a][i];
      for (std::size_t j = 0; j < kTerms; ++j)
        with += (info.normal[i * kTerms + j] - between_.normal[i * kTerms + j]) * column[a][j];
      with += surface_m2 * held_.of_surface[a] * errors_.of_surface[i] +
              lag_s2 * held_.of_lag[a] * errors_.of_lag[i];
    }
  }
  for (std::size_t a = 0; a < kHeld.size(); ++a)
    for (std::size_t b = 0; b < kHeld.size(); ++b) {
      double of_prior = 0.0;  // kappa and e depart from their prior once, not once for each place
      for (std::size_t i = 0; i < kTerms; ++i)
        for (std::size_t j = 0; j < kTerms; ++j)
          if (of_curve(i) && of_curve(j))
            of_prior += column[a][i] * prior.normal[i * kTerms + j] * column[b][j];
      held_.covariance[kHeld.size() * a + b] = column[a][kHeld[b]] + places * (places - 1.0) * of_prior +
                                               surface_m2 * held_.of_surface[a] * held_.of_surface[b] +
                                               lag_s2 * held_.of_lag[a] * held_.of_lag[b];
    }
}

// Fixes c, lambda and e at their estimates. A lambda that is not estimated yet keeps its prior variance.
void ProfileSolver::hold(Information& info) const noexcept {
  const double precision = held_.fitted ? 1.0 : 1.0 / (prior_.steady_drag_sd * prior_.steady_drag_sd);
  for (std::size_t a = 0; a < kHeld.size(); ++a) {
    const std::size_t term = kHeld[a];
    if (!held_.holds(term)) continue;
    for (std::size_t i = 0; i < kTerms; ++i) {
      info.moment[i] -= held_.mean[a] * info.normal[i * kTerms + term];
      info.normal[i * kTerms + term] = info.normal[term * kTerms + i] = 0.0;
    }
    info.normal[term * kTerms + term] = precision;
    info.moment[term] = precision * held_.mean[a];
  }
}

// Covariance of the moment's errors by the depth, the strengths of the places, and c, lambda and e.
ProfileSolver::Matrix<ProfileSolver::kTerms> ProfileSolver::moment_errors() const noexcept {
  Matrix<kTerms> errors{};
  for (std::size_t i = 0; i < kTerms; ++i)
    for (std::size_t j = 0; j < kTerms; ++j) {
      if (held_.holds(i) || held_.holds(j)) continue;
      double& value = errors[i * kTerms + j];
      value = errors_.moment[i * kTerms + j];
      for (std::size_t a = 0; a < kHeld.size(); ++a) {
        const auto &of = held_.of_error[a], &with = held_.with_moment[a];
        value -= with[i] * of[j] + of[i] * with[j];
        for (std::size_t b = 0; b < kHeld.size(); ++b)
          value += held_.covariance[kHeld.size() * a + b] * of[i] * held_.of_error[b][j];
      }
    }
  add_strength_errors(errors);
  return errors;
}

// Part of the mean's covariance by the errors that all strides share.
ProfileSolver::Matrix<ProfileSolver::kTerms> ProfileSolver::shared_errors(
    const Matrix<kTerms>& gain) const noexcept {
  Matrix<kTerms> covariance{};
  Vector<kTerms> surface{}, lag{};
  for (std::size_t i = 0; i < kTerms; ++i) {
    if (held_.holds(i)) continue;
    surface[i] = errors_.of_surface[i];
    lag[i] = errors_.of_lag[i];
    for (std::size_t a = 0; a < kHeld.size(); ++a) {
      surface[i] -= held_.of_error[a][i] * held_.of_surface[a];
      lag[i] -= held_.of_error[a][i] * held_.of_lag[a];
    }
  }
  add_error(gain, surface, prior_.shared_surface_sd_m, covariance);
  add_error(gain, lag, prior_.depth_lag_sd_s, covariance);
  return covariance;
}

}  // namespace sandhopper
