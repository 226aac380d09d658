#include "terrain/strength_profile.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "terrain/small_gaussian.hpp"

namespace sandhopper {
namespace {

constexpr std::size_t kN = kProfileCells;

// Grid of the smoothness length, from one cell to several times the profile's depth, and of the spread, from
// half to six times the stated one. A crust needs the large spread.
constexpr std::array<double, 5> kSmoothness_m{0.003, 0.01, 0.03, 0.1, 0.3};
constexpr std::array<double, 4> kSpreadFactor{0.5, 1.0, 2.5, 6.0};
constexpr std::size_t kGrid = kSmoothness_m.size() * kSpreadFactor.size();
constexpr int kPasses = 3;

// Cell of the shallowest sample.
std::size_t first_observed(const ProfileSums& sums) noexcept {
  const auto first =
      std::ranges::find_if(sums.cells, [](const ProfileCell& c) { return c.observations > 0.0; });
  return static_cast<std::size_t>(first - sums.cells.begin());
}

struct Column {
  ProfileFeature feature;
  double scale;
  std::size_t term;
};

}  // namespace

ProfileSolver::ProfileSolver(const StiffnessConfig& config)
    : config_(config),
      prior_(config.profile_or_default()),
      reloading_(prior_, config.joint.force_noise_N, config.joint.force_scale_relative) {
  for (std::size_t j = 0; j < kN; ++j) {
    const double top_m = static_cast<double>(j) * kProfileCell_m;
    believed_N_per_m_[j] =
        (believed_force_N(config, top_m + kProfileCell_m) - believed_force_N(config, top_m)) / kProfileCell_m;
    const double dz0 = config.joint.intercept_growth_depth_m;
    intercept_N_per_m_[j] = prior_.believed_stiffness_N_per_m *
                            (std::exp(-top_m / dz0) - std::exp(-(top_m + kProfileCell_m) / dz0)) /
                            kProfileCell_m;
  }
  restart();
}

void ProfileSolver::restart() noexcept {
  kept_normal_ = {};
  kept_moment_ = {};
  kept_errors_ = errors_ = {};
  between_ = kept_place_ = place_ = {};
  earlier_ = {};
  place_variance_ = {};
  kept_strength_ = strength_ = earlier_strength_ = {};
  earlier_strength_squares_ = {};
  held_ = {};
  begins_m_ = friction_N_ = 0.0;
  begins_of_ = {};
  posterior_ = {};
  posterior_.mean[kAddedMass] = config_.joint.added_mass_factor;
  profile_ = {};
  response_ = {};
  slope_N_per_m_ = believed_N_per_m_;
  reloading_.restart();
  unresolved_N2_.fill(0.0);
  misfit_ = stride_misfit_ = {};
  places_ = 0;
  line_weight_ = line_sum_ = line_degrees_ = 0.0;
}

// Normal equations of a stride. A sample in cell s contains every cell above s in full, and its own cell up
// to its position. A depth error changes its force by the slope of the previous posterior.
ProfileSolver::Information ProfileSolver::information_of(const ProfileSums& sums) const noexcept {
  using F = ProfileFeature;
  Information info;
  for (std::size_t s = 0; s < kN; ++s) {
    const ProfileCell& cell = sums.cells[s];
    const std::array<Column, 5> own{{{F::place, kProfileCell_m, s},
                                     {F::added_mass, 1.0, kAddedMass},
                                     {F::motor, 1.0, kScale},
                                     {F::intercept, prior_.believed_stiffness_N_per_m, kIntercept},
                                     {F::steady_drag, 1.0, kSteadyDrag}}};
    if (cell.observations == 0.0) continue;
    const double weight = 1.0 / noise_factor_[s], slope = slope_N_per_m_[s];
    const auto product = [&](F a, F b) { return weight * cell.product(a, b); };
    const double sum = product(F::one, F::one);
    info.time_s[s] = product(F::one, F::time) / sum;
    info.change_mps[s] = product(F::one, F::speed) / sum;
    info.depth_moment[s] = slope * product(F::one, F::force);
    info.depth_normal[s] = slope * slope * sum;
    info.friction_of_depth[s] = slope * product(F::one, F::friction);
    info.friction_normal += product(F::friction, F::friction);
    info.friction_moment += product(F::friction, F::force);
    for (const Column& a : own) {
      info.moment[a.term] += a.scale * product(a.feature, F::force);
      info.with_friction[a.term] += a.scale * product(a.feature, F::friction);
      for (const Column& b : own)
        info.normal[a.term * kTerms + b.term] += a.scale * b.scale * product(a.feature, b.feature);
      info.of_depth[s][a.term] = a.scale * slope * product(a.feature, F::one);
    }
    for (std::size_t i = 0; i < s; ++i) {
      info.moment[i] += kProfileCell_m * product(F::one, F::force);
      info.with_friction[i] += kProfileCell_m * product(F::one, F::friction);
      info.of_depth[s][i] = kProfileCell_m * slope * sum;
      for (const Column& b : own) {
        const double value = kProfileCell_m * b.scale * product(F::one, b.feature);
        info.normal[i * kTerms + b.term] += value;
        info.normal[b.term * kTerms + i] += value;
      }
      for (std::size_t j = 0; j < s; ++j)
        info.normal[i * kTerms + j] += kProfileCell_m * kProfileCell_m * sum;
    }
  }
  info.moment[kAddedMass] += sums.response;
  info.normal[kAddedMass * kTerms + kAddedMass] += sums.response_squared;
  return info;
}

// Solves at one grid point. `p.gain` is set on demand. Returns the log evidence.
double ProfileSolver::solve_at(std::size_t point, const Information& data, Posterior& p,
                               bool with_gain) const noexcept {
  Information info = data;
  p.smoothness_m = kSmoothness_m[point / kSpreadFactor.size()];
  p.spread = prior_.stiffness_spread_relative * kSpreadFactor[point % kSpreadFactor.size()];
  const double log_prior = add_shared_prior(info, p.smoothness_m, p.spread);
  hold(info);
  const Cholesky<kTerms> root(info.normal);
  p.mean = root.solve(info.moment);
  if (with_gain) p.gain = root.inverse();
  double fit = 0.0;
  for (std::size_t i = 0; i < kTerms; ++i) fit += info.moment[i] * p.mean[i];
  return log_prior - root.half_log_determinant() + 0.5 * fit;
}

// N^-1 + N^-1 E N^-1, with E the moment's errors.
ProfileSolver::Matrix<ProfileSolver::kTerms> ProfileSolver::covariance_of(
    const Matrix<kTerms>& gain, const Matrix<kTerms>& errors) const noexcept {
  Matrix<kTerms> product{}, covariance = gain;
  for (std::size_t i = 0; i < kTerms; ++i)
    for (std::size_t k = 0; k < kTerms; ++k)
      for (std::size_t j = 0; j < kTerms; ++j)
        product[i * kTerms + j] += gain[i * kTerms + k] * errors[k * kTerms + j];
  for (std::size_t i = 0; i < kTerms; ++i)
    for (std::size_t k = 0; k < kTerms; ++k)
      for (std::size_t j = 0; j < kTerms; ++j)
        covariance[i * kTerms + j] += product[i * kTerms + k] * gain[k * kTerms + j];
  if (!held_.fitted) return covariance;
  for (std::size_t a = 0; a < kHeld.size(); ++a)
    for (std::size_t b = 0; b < kHeld.size(); ++b)
      covariance[kHeld[a] * kTerms + kHeld[b]] = held_.covariance[kHeld.size() * a + b];
  return covariance;
}

// Adds the covariance of the mean that an error with this standard deviation causes. `of_error`: change of
// the moment, over all strides, for a unit of it.
void ProfileSolver::add_error(const Matrix<kTerms>& gain, const Vector<kTerms>& of_error, double sd,
                              Matrix<kTerms>& covariance) const noexcept {
  Vector<kTerms> change{};
  for (std::size_t i = 0; i < kTerms; ++i)
    for (std::size_t k = 0; k < kTerms; ++k) change[i] += sd * gain[i * kTerms + k] * of_error[k];
  for (std::size_t i = 0; i < kTerms; ++i)
    for (std::size_t j = 0; j < kTerms; ++j) covariance[i * kTerms + j] += change[i] * change[j];
}

// Combines the posterior over the grid into one mean and, in the last pass, one covariance.
void ProfileSolver::integrate(const Information& data, bool last) noexcept {
  constexpr double kNegligible = 0.01;
  std::array<Vector<kTerms>, kGrid> means{};
  std::array<double, kGrid> weight{};
  Posterior p;
  double best = -std::numeric_limits<double>::infinity();
  for (std::size_t g = 0; g < kGrid; ++g) {
    weight[g] = solve_at(g, data, p, false);
    means[g] = p.mean;
    best = std::max(best, weight[g]);
  }
  double total = 0.0;
  for (double& w : weight) {
    w = std::exp(w - best);
    total += w = w < kNegligible ? 0.0 : w;
  }
  posterior_ = {};
  const Matrix<kTerms> errors = moment_errors();
  for (std::size_t g = 0; g < kGrid; ++g) {
    weight[g] /= total;
    for (std::size_t i = 0; i < kTerms; ++i) posterior_.mean[i] += weight[g] * means[g][i];
  }
  if (!last) {
    const auto g = static_cast<std::size_t>(std::ranges::max_element(weight) - weight.begin());
    solve_at(g, data, p, true);
    posterior_.gain = p.gain;
    posterior_.covariance = covariance_of(posterior_.gain, errors);
    posterior_.smoothness_m = p.smoothness_m;
    posterior_.spread = p.spread;
    take_jumps(p.smoothness_m, p.spread, posterior_.covariance, p.mean);
    return;
  }
  for (std::size_t g = 0; g < kGrid; ++g) {
    if (weight[g] == 0.0) continue;
    solve_at(g, data, p, true);
    const Matrix<kTerms>& gain = p.gain;
    Matrix<kTerms> covariance = covariance_of(gain, errors);
    const Matrix<kTerms> shared = shared_errors(gain);
    refer_to_mean_place(gain, covariance);
    for (std::size_t i = 0; i < gain.size(); ++i) {
      posterior_.gain[i] += weight[g] * gain[i];
      posterior_.shared[i] += weight[g] * shared[i];
    }
    posterior_.smoothness_m += weight[g] * p.smoothness_m;
    posterior_.spread += weight[g] * p.spread;
    for (std::size_t i = 0; i < kTerms; ++i)
      for (std::size_t j = 0; j < kTerms; ++j)
        posterior_.covariance[i * kTerms + j] +=
            weight[g] * (covariance[i * kTerms + j] +
                         (p.mean[i] - posterior_.mean[i]) * (p.mean[j] - posterior_.mean[j]));
  }
}

void ProfileSolver::take_slopes() noexcept {
  for (std::size_t j = 0; j < kN; ++j)
    slope_N_per_m_[j] =
        believed_N_per_m_[j] + posterior_.mean[j] + intercept_N_per_m_[j] * posterior_.mean[kIntercept];
}

// Coefficients of a cell's features whose combination is the residual of the posterior mean.
std::array<double, kProfileFeatures> ProfileSolver::residual_features(std::size_t s) const noexcept {
  const auto& m = posterior_.mean;
  double above = 0.0;
  for (std::size_t j = 0; j < s; ++j) above += kProfileCell_m * m[j];
  return {-above - slope_N_per_m_[s] * begins_m_,
          -kProfileCell_m * m[s],
          -prior_.believed_stiffness_N_per_m * m[kIntercept],
          -m[kAddedMass],
          -m[kSteadyDrag],
          0.0,
          -slope_N_per_m_[s] * prior_.depth_lag_s,
          -friction_N_,
          -m[kScale],
          1.0};
}

// Sum of the weighted squared residuals of the posterior mean in a cell.
double ProfileSolver::residual_squared(const ProfileSums& sums, std::size_t s) const noexcept {
  const auto x = residual_features(s);
  double sum = 0.0;
  for (std::size_t i = 0; i < kProfileFeatures; ++i) sum += x[i] * sums.cells[s].product_with(i, x);
  return std::max(sum, 0.0);
}

// The same, after removing the best straight line through the cell's own residuals.
double ProfileSolver::scatter_squared(const ProfileSums& sums, std::size_t s) const noexcept {
  const ProfileCell& cell = sums.cells[s];
  const auto x = residual_features(s);
  using F = ProfileFeature;
  const double one = cell.product(F::one, F::one);
  const double place = cell.product(F::one, F::place);
  const double square = cell.product(F::place, F::place);
  const double residual = cell.product_with(static_cast<std::size_t>(F::one), x);
  const double tilt = cell.product_with(static_cast<std::size_t>(F::place), x) - residual * place / one;
  const double spread = square - place * place / one;
  const double line = residual * residual / one + (spread > 1e-6 * one ? tilt * tilt / spread : 0.0);
  return std::max(residual_squared(sums, s) - line, 0.0);
}

// Variance of a sample in this cell according to its weight.
double ProfileSolver::cell_variance_N2(const ProfileSums& sums, std::size_t s) const noexcept {
  const double n = sums.cells[s].observations;
  const double force_N = n > 0.0 ? sums.cells[s].weighted_force / n : 0.0;
  const double fluctuation = config_.joint.fluctuation_relative * force_N;
  return config_.joint.force_noise_N * config_.joint.force_noise_N + fluctuation * fluctuation;
}

double chi_squared_quantile(double degrees, double normal_quantile) noexcept {
  const double n = std::max(degrees, 0.5), a = 2.0 / (9.0 * n);
  const double root = 1.0 - a + normal_quantile * std::sqrt(a);
  return n * root * root * root;
}

ProfileSolver::Misfit ProfileSolver::misfit_with(const Misfit& stride, std::size_t s) const noexcept {
  const Misfit& before = misfit_[s];
  return {before.observations + stride.observations, before.found_N2 + stride.found_N2,
          before.expected_N2 + stride.expected_N2};
}

// Depth errors become force errors through the slope. If the residuals of all strides exceed these errors at
// a level of 1 %, the excess is attributed to the curve within the cell.
void ProfileSolver::weigh_cells(const ProfileSums& sums, const Information& info, bool jumps_known) noexcept {
  constexpr double k99 = 2.326348, kAllCells99 = 3.38;  // normal quantiles for 1 % and for 1 % / 28 (all
                                                        // cells together)
  broken_cells_ = 0;
  const auto squares = own_residuals_squared(sums, info);
  const double depth_variance = kept_errors_.variance_m2;
  for (std::size_t s = 0; s < kN; ++s) {
    const double n = sums.cells[s].observations;
    if (n == 0.0) continue;
    const double own = cell_variance_N2(sums, s);
    const double depth_m2 = prior_.depth_noise_m * prior_.depth_noise_m + wander_m2(sums.cells[s]);
    const double expected = own + depth_m2 * slope_N_per_m_[s] * slope_N_per_m_[s];
    const double found = own * (jumps_known ? squares[s] : scatter_squared(sums, s)) / n;
    stride_misfit_[s] = {n, n * found, n * expected};
    const Misfit all = misfit_with(stride_misfit_[s], s);
    const double excess_N2 = (all.found_N2 - all.expected_N2) / all.observations;
    const double limit = chi_squared_quantile(all.observations, k99) / all.observations;
    unresolved_N2_[s] = all.found_N2 > limit * all.expected_N2 ? std::max(excess_N2, 0.0) : 0.0;
    broken_cells_ += n * found > chi_squared_quantile(n, kAllCells99) * expected;
    // Product of the errors of depth and slope. It is beyond the linear model and common to all samples of a
    // cell.
    const double slope_sd = tangent_N_per_m(s).sd;
    const double product = n * depth_variance * slope_sd * slope_sd;
    noise_factor_[s] = (expected + unresolved_N2_[s] + product) / own;
  }
}

void ProfileSolver::add(const ProfileSums& sums, std::uint32_t stride) noexcept {
  if (stride == 1) restart();
  reloading_.add(sums.unloading, sums.reduced_mass_kg);
  take_line(sums);
  // Without new ground the estimate stays. A place without samples is no part of the mean over the places.
  if (sums.samples == 0 && (stride > 1 || places_ > 0)) {
    report(sums, stride);
    return;
  }
  begin_depth_errors(stride > 1);
  if (stride <= 1) begin_place();
  noise_factor_.fill(1.0);
  stride_misfit_ = {};
  // Restart expectation maximisation only below the depth of the previous strides. If it continued everywhere
  // from stride to stride, it would narrow the band without new measurements.
  first_cell_ = stride > 1 ? first_observed(sums) : 0;
  std::fill(jump_.begin() + static_cast<std::ptrdiff_t>(first_cell_), jump_.end(), 1.0);
  Information info;
  held_ = {};
  for (int pass = 0; pass < kPasses; ++pass) {
    if (stride <= 1) expect_contact(sums);
    info = information_of(sums);
    if (stride <= 1) depend_on_contact(info);
    subtract_mean_depth_error(info);
    if (pass > 0) {
      add_between(info);
      integrate_places();
    }
    integrate_friction(info);
    take_depth_errors(info);
    take_strength(info);
    add_kept(info);
    if (pass > 0) take_held(info);
    integrate(info, pass + 1 == kPasses);
    take_friction(info);
    if (pass + 1 == kPasses) take_responses(sums, info);
    take_slopes();
    if (pass + 1 < kPasses) weigh_cells(sums, info, pass + 2 == kPasses);
  }
  for (std::size_t s = 0; s < kN; ++s) misfit_[s] = misfit_with(stride_misfit_[s], s);
  end_depth_errors(info, sums);
  keep(info);
  report(sums, stride);
}

}  // namespace sandhopper
