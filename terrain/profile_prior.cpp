#include <algorithm>
#include <cmath>

#include "terrain/strength_profile.hpp"

// Prior of the curve: a smooth random walk of the tangent stiffness with heavy-tailed steps, and of the other
// terms.
namespace sandhopper {
namespace {

constexpr double kDegrees = 1.0;  // degrees of freedom of Student's distribution; 1 is the Cauchy
                                  // distribution

}  // namespace

// Coefficients of the innovation of kappa from one cell to the next, in units of the prior: here * kappa_j +
// above * kappa_j-1.
ProfileSolver::Innovation ProfileSolver::innovation(std::size_t j, double keep, double fresh,
                                                    double spread) const noexcept {
  if (j == 0) return {1.0 / (spread * believed_N_per_m_[0]), 0.0};
  return {1.0 / (fresh * spread * believed_N_per_m_[j]), -keep / (fresh * spread * believed_N_per_m_[j - 1])};
}

// One step of expectation maximisation for innovations with Student's distribution: the variance of each
// innovation given its expected square.
void ProfileSolver::take_jumps(double smoothness_m, double spread, const Matrix<kTerms>& covariance,
                               const Vector<kTerms>& mean) noexcept {
  const double keep = std::exp(-kProfileCell_m / smoothness_m);
  const double fresh = std::sqrt(1.0 - keep * keep);
  for (std::size_t j = first_cell_; j < kProfileCells; ++j) {
    const Innovation r = innovation(j, keep, fresh, spread);
    double value = r.here * mean[j];
    double square = r.here * r.here * covariance[j * kTerms + j];
    if (j > 0) {
      value += r.above * mean[j - 1];
      square += 2.0 * r.here * r.above * covariance[j * kTerms + j - 1] +
                r.above * r.above * covariance[(j - 1) * kTerms + j - 1];
    }
    jump_[j] = (kDegrees + value * value + square) / (kDegrees + 1.0);
  }
}

// Adds the prior of all terms at one grid point. Returns half the logarithm of the determinant of kappa's.
double ProfileSolver::add_shared_prior(Information& info, double smoothness_m, double spread) const noexcept {
  const double keep = std::exp(-kProfileCell_m / smoothness_m);
  const double fresh = std::sqrt(1.0 - keep * keep);
  double log_root = 0.0;
  for (std::size_t j = 0; j < kProfileCells; ++j) {
    const Innovation r = innovation(j, keep, fresh, spread);
    const double precision = 1.0 / jump_[j];
    log_root += std::log(r.here) - 0.5 * std::log(jump_[j]);
    info.normal[j * kTerms + j] += precision * r.here * r.here;
    if (j == 0) continue;
    info.normal[(j - 1) * kTerms + j - 1] += precision * r.above * r.above;
    info.normal[(j - 1) * kTerms + j] += precision * r.above * r.here;
    info.normal[j * kTerms + j - 1] += precision * r.above * r.here;
  }
  const auto& joint = config_.joint;
  const double mass = 1.0 / (joint.added_mass_factor_sd * joint.added_mass_factor_sd);
  info.normal[kAddedMass * kTerms + kAddedMass] += mass;
  info.moment[kAddedMass] += mass * joint.added_mass_factor;
  const double scale_sd = std::max(joint.force_scale_relative, 1e-6);
  info.normal[kScale * kTerms + kScale] += 1.0 / (scale_sd * scale_sd);
  info.normal[kIntercept * kTerms + kIntercept] +=
      1.0 / (joint.intercept_depth_sd_m * joint.intercept_depth_sd_m);
  info.normal[kSteadyDrag * kTerms + kSteadyDrag] += 1.0 / (prior_.steady_drag_sd * prior_.steady_drag_sd);
  return log_root;
}

}  // namespace sandhopper
