#include <algorithm>
#include <array>
#include <cmath>

#include "terrain/strength_profile.hpp"

// Depth at which the foot is found in contact (strength_profile.hpp).
namespace sandhopper {
namespace {

// Grains are carried along (sand, gravel) or not (clay, mud, snow). Nothing is known of it before the first
// stride, so both are as likely.
constexpr double kNoInertia = 0.5;
constexpr double kCertain = 30.0;  // logarithm of odds that count as certain; keeps them finite

// Logarithm of the normal density at zero, up to a constant.
double log_density_at_zero(double mean, double sd) noexcept {
  return -0.5 * (mean / sd) * (mean / sd) - std::log(sd);
}

double square(double x) noexcept { return x * x; }

}  // namespace

// The posterior is that of a ground with inertia. The probability that there is none follows from its density
// at c = 0 before and after the strides (Dickey 1971, Annals of Mathematical Statistics 42, 204).
ProfileSolver::Blow ProfileSolver::blow_at_contact(double added_mass_kg_per_m) const noexcept {
  const std::array<double, 2> per{added_mass_kg_per_m,
                                  added_mass_kg_per_m / BedParameters{}.added_mass_recruitment};
  double mean = 0.0, variance = 0.0;
  for (std::size_t a = 0; a < per.size(); ++a) {
    mean += per[a] * posterior_.mean[kHeld[a]];
    for (std::size_t b = 0; b < per.size(); ++b)
      variance += per[a] * per[b] * posterior_.covariance[kHeld[a] * kTerms + kHeld[b]];
  }
  if (!(variance > 0.0)) return {std::max(mean, 0.0), 0.0, 0.0};  // before the first fit
  const auto& joint = config_.joint;
  const double sd = std::sqrt(std::max(posterior_.covariance[kAddedMass * kTerms + kAddedMass], 1e-12));
  const double log_ratio = log_density_at_zero(posterior_.mean[kAddedMass], sd) -
                           log_density_at_zero(joint.added_mass_factor, joint.added_mass_factor_sd);
  return {mean, std::sqrt(variance),
          kNoInertia / (1.0 - kNoInertia) * std::exp(std::min(log_ratio, kCertain))};
}

// The same if the blow is known, without the errors of surface and cycle. The curve near the surface is taken
// as a line in each cell.
ProfileSolver::ContactDepth ProfileSolver::found_at(double speed_mps, double blow_N) const noexcept {
  constexpr int kHalvings = 24;  // to a nanosecond
  const double threshold_N = config_.contact_force_N - prior_.contact_early_N;
  std::array<double, kContactCells> passed_m{};
  double gain = 0.0;
  // The foot is found at a force that rises.
  const auto rising_N_per_m = [&](std::size_t j) { return std::max(slope_N_per_m_[j], 0.0); };
  const auto force_N = [&](double time_s) {
    gain = 1.0 - std::exp(-time_s / kAccelLowPass_s);
    const double depth_m = speed_mps * (time_s - kAccelLowPass_s * gain);
    double sum_N = blow_N * gain;
    for (std::size_t j = 0; j < kContactCells; ++j) {
      passed_m[j] = std::clamp(depth_m - static_cast<double>(j) * kProfileCell_m, 0.0, kProfileCell_m);
      sum_N += rising_N_per_m(j) * passed_m[j];
    }
    return sum_N;
  };
  double early_s = 0.0, late_s = kContactCells * kProfileCell_m / speed_mps + kAccelLowPass_s;
  ContactDepth found{.mean_m = speed_mps * late_s};
  if (!(force_N(late_s) > threshold_N)) {  // not within these cells
    found.variance_m2 = square(found.mean_m);
    return found;
  }
  for (int i = 0; i < kHalvings; ++i) {
    const double time_s = 0.5 * (early_s + late_s);
    (force_N(time_s) < threshold_N ? early_s : late_s) = time_s;
  }
  force_N(late_s);
  const double slope_N_per_m = rising_N_per_m(passed_m[1] > 0.0 ? 1 : 0);
  const double rate_N_per_s = blow_N * (1.0 - gain) / kAccelLowPass_s + slope_N_per_m * speed_mps * gain;
  const double m_per_N = speed_mps / std::max(rate_N_per_s, 1e-9);
  found.mean_m = speed_mps * late_s;
  found.variance_m2 = square(std::min(prior_.contact_force_sd_N * m_per_N, found.mean_m));
  for (std::size_t j = 0; j < kContactCells; ++j) found.of_slope[j] = -m_per_N * passed_m[j];
  return found;
}

ProfileSolver::ContactDepth ProfileSolver::contact_depth(double speed_mps,
                                                         double added_mass_kg_per_m) const noexcept {
  constexpr int kPoints = 5;  // on each side of the mean, half a standard deviation apart
  const double surface_m2 = square(prior_.surface_sd_m) + square(prior_.shared_surface_sd_m);
  if (!(speed_mps > 0.0)) return {0.0, surface_m2, {}};
  const Blow blow = blow_at_contact(added_mass_kg_per_m);
  ContactDepth depth;
  double total = 0.0, square_m2 = 0.0;
  const auto add = [&](double weight, double blow_kg_per_m) {
    const ContactDepth found = found_at(speed_mps, blow_kg_per_m * speed_mps * speed_mps);
    total += weight;
    depth.mean_m += weight * found.mean_m;
    square_m2 += weight * square(found.mean_m);
    depth.variance_m2 += weight * found.variance_m2;
    for (std::size_t j = 0; j < kContactCells; ++j) depth.of_slope[j] += weight * found.of_slope[j];
  };
  const int points = blow.sd_kg_per_m > 0.0 ? kPoints : 0;
  for (int i = -points; i <= points; ++i) {
    const double u = 0.5 * i, at_kg_per_m = blow.mean_kg_per_m + u * blow.sd_kg_per_m;
    if (at_kg_per_m >= 0.0) add(std::exp(-0.5 * u * u), at_kg_per_m);
  }
  // No inertia. If no point of the posterior is positive, this is all.
  add(total > 0.0 ? total * blow.odds_of_none : 1.0, 0.0);
  depth.mean_m /= total;
  depth.variance_m2 = depth.variance_m2 / total + std::max(square_m2 / total - square(depth.mean_m), 0.0);
  for (double& of_slope : depth.of_slope) of_slope /= total;
  depth.mean_m += prior_.contact_time_s * speed_mps;
  depth.variance_m2 += surface_m2 + square(prior_.contact_time_sd_s * speed_mps);
  return depth;
}

void ProfileSolver::expect_contact(const ProfileSums& sums) noexcept {
  const auto depth = contact_depth(sums.contact_mps, sums.contact_added_mass_kg_per_m);
  begins_m_ = depth.mean_m;
  begins_of_ = {};
  for (std::size_t j = 0; j < kContactCells; ++j) {
    begins_of_[j] = depth.of_slope[j];
    begins_of_[kIntercept] += depth.of_slope[j] * intercept_N_per_m_[j];
  }
  kept_errors_.variance_m2 = depth.variance_m2;
}

}  // namespace sandhopper
