#include <algorithm>
#include <cmath>
#include <limits>

#include "terrain/strength_profile.hpp"

namespace sandhopper {
namespace {

constexpr ProfilePoint kNowhere{std::numeric_limits<double>::quiet_NaN(),
                                std::numeric_limits<double>::quiet_NaN()};

bool within(double depth_m) { return depth_m >= 0.0 && depth_m <= kProfileDepth_m; }

}  // namespace

// Mean tangent stiffness of a cell.
ProfilePoint ProfileSolver::tangent_N_per_m(std::size_t cell) const noexcept {
  const auto& c = posterior_.covariance;
  const double b = intercept_N_per_m_[cell];
  const double variance = c[cell * kTerms + cell] + 2.0 * b * c[cell * kTerms + kIntercept] +
                          b * b * c[kIntercept * kTerms + kIntercept];
  return {believed_N_per_m_[cell] + posterior_.mean[cell] + b * posterior_.mean[kIntercept],
          std::sqrt(std::max(variance, 0.0))};
}

// Expected square of the change of slope across a cell, relative to the believed bed.
double ProfileSolver::slope_change_squared(std::size_t cell) const noexcept {
  const std::size_t a = cell > 0 ? cell - 1 : 0, b = std::min(cell + 1, kProfileCells - 1);
  const double scale = 1.0 / static_cast<double>(b - a);
  const auto& c = posterior_.covariance;
  const double change = posterior_.mean[b] - posterior_.mean[a];
  const double variance = c[a * kTerms + a] + c[b * kTerms + b] - 2.0 * c[a * kTerms + b];
  return scale * scale * (change * change + std::max(variance, 0.0));
}

ProfilePoint ProfileSolver::force_N(double depth_m, Band band) const noexcept {
  ProfilePoint point;
  if (!within(depth_m)) return kNowhere;
  const auto cell = std::min(static_cast<std::size_t>(depth_m / kProfileCell_m), kProfileCells - 1);
  const double share = depth_m / kProfileCell_m - static_cast<double>(cell);
  point.value = believed_force_N(config_, depth_m);
  Vector<kTerms> x{};
  for (std::size_t i = 0; i <= cell; ++i) x[i] = kProfileCell_m * (i < cell ? 1.0 : share);
  x[kIntercept] = prior_.believed_stiffness_N_per_m * intercept_growth(config_.joint, depth_m);
  double variance = 0.0, gain = 0.0;
  for (std::size_t j = 0; j < kTerms; ++j) {
    point.value += x[j] * posterior_.mean[j];
    double row = 0.0, follows = 0.0;
    for (std::size_t i = 0; i < kTerms; ++i) {
      row += x[i] * posterior_.covariance[i * kTerms + j];
      follows += x[i] * posterior_.gain[i * kTerms + j];
    }
    variance += row * x[j];
    gain += follows * response_[cell][j];
  }
  // The fluctuation f of a single place is part of its curve. The estimate follows it by the factor `gain`,
  // and `variance` already contains (gain f)^2 as an error. The correct error is f^2 (1 - gain)^2, so add
  // f^2 (1 - 2 gain). The curve common to several places has no fluctuation, and `variance` is correct.
  const double fluctuation = places_ > 1 ? 0.0 : config_.joint.fluctuation_relative * point.value;
  const double fluctuation_N2 = fluctuation * fluctuation * (1.0 - 2.0 * std::clamp(gain, 0.0, 1.0));
  const double variance_N2 = std::max(variance + fluctuation_N2, 0.0);
  if (band == Band::narrowable) {
    double shared_N2 = 0.0;
    for (std::size_t i = 0; i < kTerms; ++i)
      for (std::size_t j = 0; j < kTerms; ++j) shared_N2 += x[i] * posterior_.shared[i * kTerms + j] * x[j];
    point.sd = std::sqrt(std::max(variance_N2 - shared_N2, 0.0));
    return point;
  }
  // Variance of the curve within a cell: the cell's unresolved scatter, and the change of slope between its
  // neighbours.
  const auto neighbour = share < 0.5 ? (cell > 0 ? cell - 1 : cell) : std::min(cell + 1, kProfileCells - 1);
  const double nearer = std::abs(share - 0.5);
  const double unresolved = std::max(unresolved_N2_[cell], 2.0 * nearer * unresolved_N2_[neighbour]);
  const double bend = 0.5 * kProfileCell_m * share * (1.0 - share);
  point.sd = std::sqrt(variance_N2 + unresolved + bend * bend * slope_change_squared(cell));
  return point;
}

// All strides of one trial are on one bed, so they differ only by noise. The error of the torque constant is
// common to all.
void ProfileSolver::take_line(const ProfileSums& sums) noexcept {
  const auto joint = solve_joint(joint_sums_of(sums, config_), config_);
  const double scale_N_per_m = config_.joint.force_scale_relative * joint.value_N_per_m;
  const double se = joint.standard_error_N_per_m;
  const double own = se * se - scale_N_per_m * scale_N_per_m;
  if (!(joint.value_N_per_m > 0.0) || !(own > 0.0)) return;
  line_weight_ += 1.0 / own;
  line_sum_ += joint.value_N_per_m / own;
  line_degrees_ += std::max(joint.observations - 3.0, 1.0);
}

ProfileSolver::Line ProfileSolver::line() const noexcept {
  if (line_weight_ == 0.0) return {kNowhere.value, kNowhere.value, kNowhere.value};
  const double value = line_sum_ / line_weight_;
  const double scale_N_per_m = config_.joint.force_scale_relative * value;
  const double half =
      student_975(line_degrees_) * std::sqrt(1.0 / line_weight_ + scale_N_per_m * scale_N_per_m);
  return {value, value - half, value + half};
}

ProfilePoint force_at(const StrengthProfile& p, double depth_m) noexcept {
  if (!within(depth_m)) return kNowhere;
  const double place = depth_m / kProfilePoint_m;
  const auto i = std::min(static_cast<std::size_t>(place), kProfilePoints - 1);
  const double share = place - static_cast<double>(i);
  const double above = i > 0 ? p.force_N[i - 1] : 0.0, above_sd = i > 0 ? p.force_sd_N[i - 1] : 0.0;
  return {above + share * (p.force_N[i] - above), above_sd + share * (p.force_sd_N[i] - above_sd)};
}

ProfilePoint tangent_at(const StrengthProfile& p, double depth_m) noexcept {
  if (!within(depth_m)) return kNowhere;
  const auto cell = std::min(static_cast<std::size_t>(depth_m / kProfileCell_m), kProfileCells - 1);
  return {p.tangent_N_per_m[cell], p.tangent_sd_N_per_m[cell]};
}

void ProfileSolver::report(const ProfileSums& sums, std::uint32_t stride) noexcept {
  StrengthProfile& p = profile_;
  const bool first = p.stride == 0;
  p.stride = stride > 0 ? stride : p.stride + 1;
  p.samples = sums.samples;
  if (sums.samples > 0) {
    p.depth_min_m = first ? sums.depth_min_m : std::min(p.depth_min_m, sums.depth_min_m);
    p.depth_max_m = std::max(p.depth_max_m, sums.depth_max_m);
  }
  for (std::size_t i = 0; i < kProfilePoints; ++i) {
    const ProfilePoint force = force_N(static_cast<double>(i + 1) * kProfilePoint_m);
    p.force_N[i] = static_cast<float>(force.value);
    p.force_sd_N[i] = static_cast<float>(force.sd);
  }
  double residual = 0.0, observations = 0.0;
  for (std::size_t j = 0; j < kProfileCells; ++j) {
    const ProfilePoint tangent = tangent_N_per_m(j);
    p.tangent_N_per_m[j] = static_cast<float>(tangent.value);
    p.tangent_sd_N_per_m[j] = static_cast<float>(tangent.sd);
    p.observations[j] += static_cast<float>(sums.cells[j].observations);
    residual += residual_squared(sums, j);
    observations += sums.cells[j].observations;
  }
  const auto& m = posterior_.mean;
  p.added_mass_factor = m[kAddedMass];
  p.added_mass_factor_sd = std::sqrt(std::max(posterior_.covariance[kAddedMass * kTerms + kAddedMass], 0.0));
  p.smoothness_m = posterior_.smoothness_m;
  p.spread_relative = posterior_.spread;
  p.joint_friction_N = friction_N_;
  p.chi_squared = observations > 0.0 ? residual / observations : 0.0;
}

}  // namespace sandhopper
