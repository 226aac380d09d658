#include <algorithm>
#include <cmath>

#include "terrain/small_gaussian.hpp"
#include "terrain/strength_profile.hpp"

// Places on ground prepared alike: their strengths differ.
namespace sandhopper {
namespace {

// Standard deviation of the strength at the surface, relative to the configured one, and its prior
// probability: Gauss-Hermite quadrature of three points for a log-normal prior with the median 1 and a factor
// of 4 at root 3 deviations. That of the whole curve is the configured one: with a prior as wide, a depth
// that only one place has reached would be less known with two places than with one.
constexpr std::array<double, 3> kPlaceFactor{0.25, 1.0, 4.0};
constexpr std::array<double, 3> kPlaceWeight{1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0};
constexpr double kNegligible = 1e-3;  // weight of a grid point that is left out

double along(const std::array<double, ProfileSolver::kTerms>& a,
             const std::array<double, ProfileSolver::kTerms>& b) noexcept {
  double sum = 0.0;
  for (std::size_t i = 0; i < kProfileCells; ++i) sum += a[i] * b[i];
  return sum;
}

}  // namespace

ProfileSolver::PlaceTerms ProfileSolver::place_shapes() const noexcept {
  const double surface_N_per_m_m = prior_.believed_stiffness_N_per_m / config_.joint.intercept_growth_depth_m;
  PlaceTerms shapes{};
  for (std::size_t j = 0; j < kProfileCells; ++j) {
    shapes[0][j] = slope_N_per_m_[j];
    shapes[1][j] = slope_N_per_m_[j] * intercept_N_per_m_[j] / surface_N_per_m_m;
  }
  return shapes;
}

double ProfileSolver::place_variance(std::size_t point, std::size_t strength) const noexcept {
  static_assert(kPlaceGrid == kPlaceFactor.size() && kStrengths == 2);
  const double sd = prior_.place_strength_sd_relative * (strength == 0 ? 1.0 : kPlaceFactor[point]);
  return sd * sd;
}

// Adds the information G of one place, with its strengths integrated out:
//   G - G U (Theta^-1 + U^T G U)^-1 U^T G
// and the logarithm of its likelihood, up to a constant that does not depend on Theta.
void ProfileSolver::add_place(const Between& place, const PlaceTerms& shapes, std::size_t point,
                              Between& sum) const noexcept {
  PlaceTerms of_strength{};  // G U
  for (std::size_t k = 0; k < kStrengths; ++k)
    for (std::size_t i = 0; i < kTerms; ++i)
      for (std::size_t j = 0; j < kProfileCells; ++j)
        of_strength[k][i] += place.normal[i * kTerms + j] * shapes[k][j];
  std::array<double, kStrengths * kStrengths> precision{};
  double log_root_prior = 0.0;
  for (std::size_t k = 0; k < kStrengths; ++k) {
    const double variance = place_variance(point, k);
    log_root_prior -= 0.5 * std::log(variance);
    for (std::size_t l = 0; l < kStrengths; ++l)
      precision[k * kStrengths + l] = along(shapes[k], of_strength[l]) + (k == l ? 1.0 / variance : 0.0);
  }
  const Cholesky<kStrengths> root(precision);
  // Adds a moment, or a row of the normal matrix. Returns the part of its square that Theta explains.
  const auto add = [&](const double* from, double* to) {
    std::array<double, kStrengths> value{};
    for (std::size_t k = 0; k < kStrengths; ++k)
      for (std::size_t j = 0; j < kProfileCells; ++j) value[k] += shapes[k][j] * from[j];
    const auto solved = root.solve(value);
    double explained = 0.0;
    for (std::size_t k = 0; k < kStrengths; ++k) explained += value[k] * solved[k];
    for (std::size_t i = 0; i < kTerms; ++i) {
      to[i] += from[i];
      for (std::size_t k = 0; k < kStrengths; ++k) to[i] -= of_strength[k][i] * solved[k];
    }
    return explained;
  };
  const double explained = add(place.moment.data(), sum.moment.data());
  sum.log_likelihood += log_root_prior - root.half_log_determinant() + 0.5 * explained;
  add(place.of_surface.data(), sum.of_surface.data());
  add(place.of_lag.data(), sum.of_lag.data());
  for (std::size_t i = 0; i < kTerms; ++i) add(&place.normal[i * kTerms], &sum.normal[i * kTerms]);
}

// The place before becomes one of the earlier ones.
void ProfileSolver::begin_place() noexcept {
  if (places_ > 0) {
    const auto shapes = place_shapes();
    for (std::size_t g = 0; g < kPlaceGrid; ++g) add_place(kept_place_, shapes, g, earlier_[g]);
    for (std::size_t k = 0; k < kStrengths; ++k)
      for (std::size_t i = 0; i < kTerms; ++i) {
        earlier_strength_[k][i] += kept_strength_[k][i];
        for (std::size_t j = 0; j < kTerms; ++j)
          earlier_strength_squares_[k][i * kTerms + j] += kept_strength_[k][i] * kept_strength_[k][j];
      }
  }
  kept_place_ = {};
  kept_strength_ = {};
  ++places_;
}

// Logarithm of the marginal likelihood of all places. `prior`: of all terms.
double ProfileSolver::log_evidence(const Between& all, const Information& prior) const noexcept {
  auto normal = prior.normal;
  auto moment = prior.moment;
  for (std::size_t i = 0; i < normal.size(); ++i) normal[i] += all.normal[i];
  for (std::size_t i = 0; i < kTerms; ++i) moment[i] += all.moment[i];
  const Cholesky<kTerms> root(normal);
  double fit = 0.0;
  for (const double x : root.scaled(moment)) fit += x * x;
  return all.log_likelihood - root.half_log_determinant() + 0.5 * fit;
}

// Averages the information of all places over the posterior of Theta.
void ProfileSolver::integrate_places() noexcept {
  place_variance_ = {};
  if (places_ < 2) {  // the curve is that of this place
    between_ = place_;
    return;
  }
  Information prior;
  add_shared_prior(prior, posterior_.smoothness_m, posterior_.spread);
  const auto shapes = place_shapes();
  std::array<Between, kPlaceGrid> all_places = earlier_;
  std::array<double, kPlaceGrid> weight{};
  for (std::size_t g = 0; g < kPlaceGrid; ++g) {
    add_place(place_, shapes, g, all_places[g]);
    weight[g] = log_evidence(all_places[g], prior) + std::log(kPlaceWeight[g]);
  }
  const double best = *std::ranges::max_element(weight);
  double total = 0.0;
  for (double& w : weight) {
    w = std::exp(w - best);
    total += w = w < kNegligible ? 0.0 : w;
  }
  between_ = {};
  for (std::size_t g = 0; g < kPlaceGrid; ++g) {
    if (weight[g] == 0.0) continue;
    const double w = weight[g] / total;
    const Between& all = all_places[g];
    for (std::size_t i = 0; i < all.normal.size(); ++i) between_.normal[i] += w * all.normal[i];
    for (std::size_t i = 0; i < kTerms; ++i) {
      between_.moment[i] += w * all.moment[i];
      between_.of_surface[i] += w * all.of_surface[i];
      between_.of_lag[i] += w * all.of_lag[i];
    }
    for (std::size_t k = 0; k < kStrengths; ++k) place_variance_[k] += w * place_variance(g, k);
  }
}

// `own`: the curve's normal equations of this stride.
void ProfileSolver::take_strength(const Information& own) noexcept {
  const auto shapes = place_shapes();
  strength_ = kept_strength_;
  for (std::size_t k = 0; k < kStrengths; ++k)
    for (std::size_t i = 0; i < kTerms; ++i)
      for (std::size_t j = 0; j < kProfileCells; ++j)
        strength_[k][i] += own.normal[i * kTerms + j] * shapes[k][j];
}

// Adds the part of the moment's covariance by the strengths of the places.
void ProfileSolver::add_strength_errors(Matrix<kTerms>& errors) const noexcept {
  if (places_ < 2) return;
  for (std::size_t i = 0; i < kTerms; ++i)
    for (std::size_t j = 0; j < kTerms; ++j) {
      if (held_.holds(i) || held_.holds(j)) continue;
      for (std::size_t k = 0; k < kStrengths; ++k)
        errors[i * kTerms + j] += place_variance_[k] * (earlier_strength_squares_[k][i * kTerms + j] +
                                                        strength_[k][i] * strength_[k][j]);
    }
}

// Changes the covariance of the mean's error from that about the expected curve to that about the mean of the
// places' curves.
void ProfileSolver::refer_to_mean_place(const Matrix<kTerms>& gain,
                                        Matrix<kTerms>& covariance) const noexcept {
  if (places_ < 2) return;
  const auto shapes = place_shapes();
  for (std::size_t k = 0; k < kStrengths; ++k) {
    const double variance = place_variance_[k] / places_;
    Vector<kTerms> moment{}, change{};  // of the mean, if this strength is one unit larger on all places
    for (std::size_t i = 0; i < kTerms; ++i) {
      if (held_.holds(i)) continue;
      moment[i] = earlier_strength_[k][i] + strength_[k][i];
      for (std::size_t a = 0; a < kHeld.size(); ++a)
        moment[i] -= held_.of_error[a][i] * held_.of_strength[a][k];
    }
    for (std::size_t i = 0; i < kTerms; ++i)
      for (std::size_t j = 0; j < kTerms; ++j) change[i] += gain[i * kTerms + j] * moment[j];
    for (std::size_t i = 0; i < kTerms; ++i)
      for (std::size_t j = 0; j < kTerms; ++j)
        covariance[i * kTerms + j] +=
            variance * (shapes[k][i] * shapes[k][j] - change[i] * shapes[k][j] - shapes[k][i] * change[j]);
  }
}

// Weighted squared residuals of the posterior mean in each cell, without the errors that this stride alone
// has: of the depth, of the friction and of the place's strengths. In each cell they are one force with the
// covariance C. The best prediction of that force from the mean residual r, whose own variance is V, leaves
// V (C + V)^-1 r.
ProfileSolver::Vector<kProfileCells> ProfileSolver::own_residuals_squared(
    const ProfileSums& sums, const Information& own) const noexcept {
  using F = ProfileFeature;
  const auto shapes = place_shapes();
  std::array<Vector<kProfileCells>, kStrengths + 1> error{};  // one standard deviation of each [N]
  std::array<double, kStrengths> above_N{};
  Vector<kProfileCells> weight{}, residual{}, square{};
  for (std::size_t s = 0; s < kProfileCells; ++s) {
    for (std::size_t k = 0; k < kStrengths; ++k) {
      const double within_N = kProfileCell_m * shapes[k][s];
      error[k][s] = std::sqrt(place_variance_[k]) * (above_N[k] + 0.5 * within_N);
      above_N[k] += within_N;
    }
    const ProfileCell& cell = sums.cells[s];
    if (cell.observations == 0.0) continue;
    auto x = residual_features(s);
    x[static_cast<std::size_t>(F::friction)] = 0.0;
    weight[s] = cell.product(F::one, F::one);
    residual[s] = cell.product_with(static_cast<std::size_t>(F::one), x) / weight[s];
    error[kStrengths][s] = config_.joint.joint_friction_sd_N * cell.product(F::one, F::friction) / weight[s];
    for (std::size_t i = 0; i < kProfileFeatures; ++i) square[s] += x[i] * cell.product_with(i, x);
  }
  auto covariance = depth_covariance(own);
  for (std::size_t s = 0; s < kProfileCells; ++s) {
    for (std::size_t t = 0; t < kProfileCells; ++t) {
      double& value = covariance[s * kProfileCells + t];
      value *= slope_N_per_m_[s] * slope_N_per_m_[t];
      if (weight[s] == 0.0 || weight[t] == 0.0) continue;
      for (const auto& e : error) value += e[s] * e[t];
    }
    covariance[s * kProfileCells + s] += weight[s] > 0.0 ? 1.0 / weight[s] : 1.0;
  }
  const auto solved = Cholesky<kProfileCells>(covariance).solve(residual);
  for (std::size_t s = 0; s < kProfileCells; ++s) {
    if (weight[s] == 0.0) continue;
    const double left = solved[s] / weight[s];
    square[s] = std::max(square[s] + weight[s] * (left * left - residual[s] * residual[s]), 0.0);
  }
  return square;
}

}  // namespace sandhopper
