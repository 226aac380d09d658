#include "terrain/profile_sums.hpp"

#include <algorithm>
#include <cmath>

namespace sandhopper {

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

void CraterReturn::follow(const JointSample& s, double contact_force_N) noexcept {
  if (s.depth_m > deepest_m && s.speed_mps > 0.0) {
    *this = {.deepest_m = s.depth_m,
             .deepest_N = s.force_N,
             .deepest_s = s.since_contact_s,
             .released_N = s.force_N};
    return;
  }
  const bool free = released_N < contact_force_N;
  if (free || !(s.force_N < released_N)) return;
  released_N = s.force_N;
  recovery_m = deepest_m - s.depth_m;
  duration_s = s.since_contact_s - deepest_s;
}

double intercept_growth(const JointConfig& config, double depth_m) noexcept {
  return 1.0 - std::exp(-depth_m / config.intercept_growth_depth_m);
}

double believed_force_N(const StiffnessConfig& config, double depth_m) noexcept {
  if (depth_m <= 0.0) return 0.0;
  return config.profile_or_default().believed_stiffness_N_per_m *
         (depth_m + config.joint.intercept_depth_m * intercept_growth(config.joint, depth_m));
}

ProfileRegression::ProfileRegression(const StiffnessConfig& config, double foot_radius_m,
                                     double reduced_mass_kg)
    : config_(config),
      believed_N_per_m_(config.profile_or_default().believed_stiffness_N_per_m),
      reduced_mass_kg_(reduced_mass_kg),
      cone_(BedParameters{}, foot_radius_m) {}

void ProfileRegression::reset() noexcept {
  if (sums_.samples + sums_.saturated + sums_.too_deep + (sums_.crater.deepest_m > 0.0)) sums_ = {};
}

void ProfileRegression::add(const JointSample& s, double motor_force_N) noexcept {
  if (!(std::abs(s.accel_mps2) < config_.joint.accel_range_mps2)) {
    ++sums_.saturated;
    return;
  }
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

  const double place = s.depth_m / kProfileCell_m;
  const auto index = std::min(static_cast<std::size_t>(place), kProfileCells - 1);
  const double growth = intercept_growth(config_.joint, s.depth_m);
  const std::array<double, kProfileFeatures> x{
      1.0,
      place - static_cast<double>(index),
      growth,
      cone_.added_mass_gradient_kg_per_m(s.depth_m) * s.speed_mps * s.speed_mps +
          cone_.added_mass_kg(s.depth_m) * s.accel_mps2,
      s.since_contact_s,
      s.speed_mps,
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
