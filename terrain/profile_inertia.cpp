#include <algorithm>

#include "terrain/small_gaussian.hpp"
#include "terrain/strength_profile.hpp"

// Added mass and steady drag, from the comparison of strides at different speeds.
namespace sandhopper {

// Adds the information of a stride on all terms, with D of each cell and f integrated out. That a stride
// begins with the depth error of its crater is left out.
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
  between_ = kept_between_;
  for (std::size_t i = 0; i < kTerms; ++i) {
    double of_surface = 0.0, of_lag = 0.0;
    for (std::size_t s = 0; s < kProfileCells; ++s) {
      of_surface += own.of_depth[s][i];
      of_lag += own.of_depth[s][i] * own.change_mps[s];
    }
    between_.moment[i] += less(own.moment[i], rows[i], data);
    between_.of_surface[i] += less(of_surface, rows[i], surface);
    between_.of_lag[i] += less(of_lag, rows[i], lag);
    for (std::size_t j = 0; j <= i; ++j) {
      const double value = less(own.normal[i * kTerms + j], rows[i], rows[j]);
      between_.normal[i * kTerms + j] += value;
      if (j < i) between_.normal[j * kTerms + i] += value;
    }
  }
}

// `info`: normal equations of the curve over all strides, without the prior.
void ProfileSolver::take_inertia(const Information& info) noexcept {
  Information prior;
  add_shared_prior(prior, posterior_.smoothness_m, posterior_.spread);
  // Strides of one set-up differ only by their errors. The prior of kappa counts once for each place, so that
  // repeating one set-up does not narrow c and lambda, and a shared error does not grow.
  const double places = std::max(places_, 1);
  auto normal = between_.normal;
  auto moment = between_.moment;
  for (std::size_t i = 0; i < kTerms; ++i) {
    moment[i] += prior.moment[i];
    for (std::size_t j = 0; j < kTerms; ++j)
      normal[i * kTerms + j] += prior.normal[i * kTerms + j] * (i < kProfileCells ? places : 1.0);
  }
  const Cholesky<kTerms> root(normal);
  const auto mean = root.solve(moment);
  const double surface_m2 = prior_.shared_surface_sd_m * prior_.shared_surface_sd_m;
  const double lag_s2 = prior_.depth_lag_sd_s * prior_.depth_lag_sd_s;
  inertia_ = {.fitted = true};
  std::array<Vector<kTerms>, kInertia.size()> column;
  for (std::size_t a = 0; a < kInertia.size(); ++a) {
    Vector<kTerms> unit{};
    unit[kInertia[a]] = 1.0;
    column[a] = root.solve(unit);
    inertia_.mean[a] = mean[kInertia[a]];
    for (std::size_t i = 0; i < kTerms; ++i) {
      inertia_.of_surface[a] += column[a][i] * between_.of_surface[i];
      inertia_.of_lag[a] += column[a][i] * between_.of_lag[i];
    }
    for (std::size_t i = 0; i < kTerms; ++i) {
      if (inertia_.holds(i)) continue;
      inertia_.of_error[a][i] = info.normal[i * kTerms + kInertia[a]];
      double& with = inertia_.with_moment[a][i];
      for (std::size_t j = 0; j < kTerms; ++j)
        with += (info.normal[i * kTerms + j] - between_.normal[i * kTerms + j]) * column[a][j];
      with += surface_m2 * inertia_.of_surface[a] * errors_.of_surface[i] +
              lag_s2 * inertia_.of_lag[a] * errors_.of_lag[i];
    }
  }
  for (std::size_t a = 0; a < kInertia.size(); ++a)
    for (std::size_t b = 0; b < kInertia.size(); ++b) {
      double of_prior = 0.0;  // kappa departs from its prior once, not once for each place
      for (std::size_t i = 0; i < kProfileCells; ++i)
        for (std::size_t j = 0; j < kProfileCells; ++j)
          of_prior += column[a][i] * prior.normal[i * kTerms + j] * column[b][j];
      inertia_.covariance[2 * a + b] = column[a][kInertia[b]] + places * (places - 1.0) * of_prior +
                                       surface_m2 * inertia_.of_surface[a] * inertia_.of_surface[b] +
                                       lag_s2 * inertia_.of_lag[a] * inertia_.of_lag[b];
    }
}

// Fixes c and lambda at their estimates. A lambda that is not estimated yet keeps its prior variance.
void ProfileSolver::hold_inertia(Information& info) const noexcept {
  const double precision = inertia_.fitted ? 1.0 : 1.0 / (prior_.steady_drag_sd * prior_.steady_drag_sd);
  for (std::size_t a = 0; a < kInertia.size(); ++a) {
    const std::size_t term = kInertia[a];
    if (!inertia_.holds(term)) continue;
    for (std::size_t i = 0; i < kTerms; ++i) {
      info.moment[i] -= inertia_.mean[a] * info.normal[i * kTerms + term];
      info.normal[i * kTerms + term] = info.normal[term * kTerms + i] = 0.0;
    }
    info.normal[term * kTerms + term] = precision;
    info.moment[term] = precision * inertia_.mean[a];
  }
}

// Covariance of the moment's errors by the depth and by c and lambda.
ProfileSolver::Matrix<ProfileSolver::kTerms> ProfileSolver::moment_errors() const noexcept {
  Matrix<kTerms> errors{};
  for (std::size_t i = 0; i < kTerms; ++i)
    for (std::size_t j = 0; j < kTerms; ++j) {
      if (inertia_.holds(i) || inertia_.holds(j)) continue;
      double& value = errors[i * kTerms + j];
      value = errors_.moment[i * kTerms + j];
      for (std::size_t a = 0; a < kInertia.size(); ++a) {
        const auto &of = inertia_.of_error[a], &with = inertia_.with_moment[a];
        value -= with[i] * of[j] + of[i] * with[j];
        for (std::size_t b = 0; b < kInertia.size(); ++b)
          value += inertia_.covariance[2 * a + b] * of[i] * inertia_.of_error[b][j];
      }
    }
  return errors;
}

// Part of the mean's covariance by the errors that all strides share.
ProfileSolver::Matrix<ProfileSolver::kTerms> ProfileSolver::shared_errors(
    const Matrix<kTerms>& gain) const noexcept {
  Matrix<kTerms> covariance{};
  Vector<kTerms> surface{}, lag{};
  for (std::size_t i = 0; i < kTerms; ++i) {
    if (inertia_.holds(i)) continue;
    surface[i] = errors_.of_surface[i];
    lag[i] = errors_.of_lag[i];
    for (std::size_t a = 0; a < kInertia.size(); ++a) {
      surface[i] -= inertia_.of_error[a][i] * inertia_.of_surface[a];
      lag[i] -= inertia_.of_error[a][i] * inertia_.of_lag[a];
    }
  }
  add_error(gain, surface, prior_.shared_surface_sd_m, covariance);
  add_error(gain, lag, prior_.depth_lag_sd_s, covariance);
  return covariance;
}

}  // namespace sandhopper
