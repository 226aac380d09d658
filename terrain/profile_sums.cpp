#include "terrain/profile_sums.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sandhopper {
namespace {

// A saturated sample, the blow of a fast foot on the ground and a step of the torque affect the force for one
// cycle plus three time constants of the IMU's 400 Hz low-pass.
constexpr double kSettling_s = 0.003;

}  // namespace

double ProfileCell::product(ProfileFeature a, ProfileFeature b) const noexcept {
  const auto i = std::min(static_cast<std::size_t>(a), static_cast<std::size_t>(b));
  const auto j = std::max(static_cast<std::size_t>(a), static_cast<std::size_t>(b));
  return products[i * kProfileFeatures - i * (i + 1) / 2 + j];
}

double ProfileCell::product_with(std::size_t feature,
                                 const std::array<double, kProfileFeatures>& factors) const noexcept {
  double sum = 0.0;
  for (std::size_t i = 0; i < kProfileFeatures; ++i)
    sum += factors[i] * product(static_cast<ProfileFeature>(feature), static_cast<ProfileFeature>(i));
  return sum;
}

double intercept_growth(const JointConfig& config, double depth_m) noexcept {
  return 1.0 - std::exp(-depth_m / config.intercept_growth_depth_m);
}

double steady_drag_kg_per_m(double foot_radius_m) noexcept {
  return BedParameters{}.bulk_density_kg_per_m3 * std::numbers::pi * foot_radius_m * foot_radius_m;
}

double believed_force_N(const StiffnessConfig& config, double depth_m) noexcept {
  if (depth_m <= 0.0) return 0.0;
  return config.profile_or_default().believed_stiffness_N_per_m *
         (depth_m + config.joint.intercept_depth_m * intercept_growth(config.joint, depth_m));
}

JointSums joint_sums_of(const ProfileSums& sums, const StiffnessConfig& config) noexcept {
  using F = ProfileFeature;
  using Factors = std::array<double, kProfileFeatures>;
  const auto at = [](F feature) { return static_cast<std::size_t>(feature); };
  const double k = config.profile_or_default().believed_stiffness_N_per_m;
  JointSums joint{.depth_min_m = sums.depth_min_m,
                  .depth_max_m = sums.depth_max_m,
                  .samples = sums.samples,
                  .saturated = sums.saturated};
  for (std::size_t s = 0; s < kProfileCells; ++s) {
    const ProfileCell& cell = sums.cells[s];
    if (cell.observations == 0.0) continue;
    std::array<Factors, kJointTerms + 1> factors{};  // of the joint fit's terms, then of the force
    const auto term = [&](JointTerm t) -> Factors& { return factors[static_cast<std::size_t>(t)]; };
    Factors& depth = term(JointTerm::stiffness);
    depth[at(F::one)] = static_cast<double>(s) * kProfileCell_m;
    depth[at(F::place)] = kProfileCell_m;
    term(JointTerm::intercept)[at(F::intercept)] = 1.0;
    term(JointTerm::added_mass)[at(F::added_mass)] = 1.0;
    term(JointTerm::surface)[at(F::one)] = 1.0;
    term(JointTerm::drift)[at(F::time)] = 1.0;
    term(JointTerm::friction)[at(F::friction)] = 1.0;
    Factors& force = factors[kJointTerms];
    for (std::size_t i = 0; i < kProfileFeatures; ++i) force[i] = k * depth[i];
    force[at(F::intercept)] += k * config.joint.intercept_depth_m;
    force[at(F::force)] = 1.0;
    const auto product = [&](const Factors& a, const Factors& b) {
      double sum = 0.0;
      for (std::size_t i = 0; i < kProfileFeatures; ++i)
        if (a[i] != 0.0) sum += a[i] * cell.product_with(i, b);
      return sum;
    };
    for (std::size_t i = 0; i < kJointTerms; ++i) {
      for (std::size_t j = 0; j < kJointTerms; ++j)
        joint.normal[kJointTerms * i + j] += product(factors[i], factors[j]);
      joint.moment[i] += product(factors[i], force);
    }
    joint.force_squared += product(force, force);
    joint.observations += cell.observations;
  }
  return joint;
}

ProfileRegression::ProfileRegression(const StiffnessConfig& config, double foot_radius_m,
                                     double reduced_mass_kg)
    : config_(config),
      believed_N_per_m_(config.profile_or_default().believed_stiffness_N_per_m),
      reduced_mass_kg_(reduced_mass_kg),
      cone_(BedParameters{}, foot_radius_m),
      drag_kg_per_m_(steady_drag_kg_per_m(foot_radius_m)) {}

double ProfileRegression::inertia_N(const JointSample& s) const noexcept {
  return config_.joint.added_mass_factor *
         (cone_.added_mass_gradient_kg_per_m(s.depth_m) * s.speed_mps * s.speed_mps +
          cone_.added_mass_kg(s.depth_m) * s.accel_mps2);
}

void ProfileRegression::reset() noexcept {
  settled_s_ = start_s_ = start_speed_mps_ = 0.0;
  starts_ = false;
  sums_.contact_mps = 0.0;
  if (sums_.samples + sums_.saturated + sums_.too_deep > 0) sums_ = {};
}

void ProfileRegression::on_contact(double speed_mps, bool in_crater) noexcept {
  start_s_ = 0.0;
  start_speed_mps_ = speed_mps;
  starts_ = in_crater;
  if (!in_crater) settled_s_ = kSettling_s;
  sums_.contact_mps = speed_mps;
  sums_.contact_added_mass_kg_per_m = cone_.added_mass_gradient_kg_per_m(0.0);
}

bool ProfileRegression::watch(const JointSample& s) noexcept {
  if (!(std::abs(s.accel_mps2) < config_.joint.accel_range_mps2))
    settled_s_ = s.since_contact_s + kSettling_s;
  return s.since_contact_s >= settled_s_;
}

void ProfileRegression::on_phase_change(double since_contact_s) noexcept {
  settled_s_ = std::max(settled_s_, since_contact_s + kSettling_s);
}

void ProfileRegression::add(const JointSample& s, double motor_force_N) noexcept {
  const bool settled = watch(s);
  if (!(std::abs(s.accel_mps2) < config_.joint.accel_range_mps2)) {
    ++sums_.saturated;
    return;
  }
  if (!settled) return;
  if (!(s.depth_m > 0.0)) return;
  if (!(s.depth_m < kProfileDepth_m)) {
    ++sums_.too_deep;
    return;
  }
  const double new_ground = s.speed_mps * std::max(s.duration_s, 0.0) / config_.joint.fluctuation_length_m;
  const double share = std::clamp(new_ground, 0.0, 1.0);
  const double fluctuation = config_.joint.fluctuation_relative * s.force_N;
  const double weight =
      share / (config_.joint.force_noise_N * config_.joint.force_noise_N + fluctuation * fluctuation);
  if (!std::isfinite(weight)) return;

  if (starts_) {
    start_s_ = s.since_contact_s;
    start_speed_mps_ = s.speed_mps;
    starts_ = false;
  }
  sums_.last_s = s.since_contact_s - start_s_;
  sums_.last_change_mps = s.speed_mps - start_speed_mps_;
  const double place = s.depth_m / kProfileCell_m;
  const auto index = std::min(static_cast<std::size_t>(place), kProfileCells - 1);
  const double growth = intercept_growth(config_.joint, s.depth_m);
  const std::array<double, kProfileFeatures> x{
      1.0,
      place - static_cast<double>(index),
      growth,
      cone_.added_mass_gradient_kg_per_m(s.depth_m) * s.speed_mps * s.speed_mps +
          cone_.added_mass_kg(s.depth_m) * s.accel_mps2,
      drag_kg_per_m_ * s.speed_mps * s.speed_mps,
      sums_.last_s,
      sums_.last_change_mps,
      std::tanh(s.leg_rate_mps / config_.joint.friction_switch_speed_mps),
      motor_force_N,
      s.force_N - believed_N_per_m_ * (s.depth_m + config_.joint.intercept_depth_m * growth)};
  ProfileCell& cell = sums_.cells[index];
  std::size_t at = 0;
  for (std::size_t i = 0; i < kProfileFeatures; ++i) {
    const double wx = weight * x[i];
    for (std::size_t j = i; j < kProfileFeatures; ++j) cell.products[at++] += wx * x[j];
  }
  cell.observations += share;
  const double response = cone_.added_mass_kg(s.depth_m) / reduced_mass_kg_;
  sums_.response += share * response;
  sums_.response_squared += share * response * response;
  cell.weighted_force += share * s.force_N;
  sums_.depth_min_m = sums_.samples == 0 ? s.depth_m : std::min(sums_.depth_min_m, s.depth_m);
  sums_.depth_max_m = std::max(sums_.depth_max_m, s.depth_m);
  ++sums_.samples;
}

}  // namespace sandhopper
