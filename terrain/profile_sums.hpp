#pragma once
#include <array>
#include <cstdint>

#include "terrain/bed.hpp"
#include "terrain/joint_fit.hpp"
#include "terrain/profile_config.hpp"
#include "terrain/reloading.hpp"

// Normal equations of the strength profile (strength_profile.hpp), accumulated in the cycle. The depth is
// divided into cells; each keeps the weighted products of nine features of its samples. The solver combines
// them after liftoff with any slope of the curve, so that the error of the depth can be a nuisance although
// the curve's slope is not known beforehand.
namespace sandhopper {

inline constexpr std::size_t kProfileCells = 28;
inline constexpr double kProfileCell_m = 0.0025;
inline constexpr double kProfileDepth_m = static_cast<double>(kProfileCells) * kProfileCell_m;

// Features of a sample: 1, place in the cell (0 to 1), 1 - exp(-z/dz0), added mass term (joint_fit.hpp) [N],
// time since contact [s], speed [m/s], direction of joint friction, force from the motors' current [N], and
// force beyond the believed bed's [N].
enum class ProfileFeature : std::size_t {
  one,
  place,
  intercept,
  added_mass,
  time,
  speed,
  friction,
  motor,
  force
};
inline constexpr std::size_t kProfileFeatures = 9;
inline constexpr std::size_t kProfileProducts = kProfileFeatures * (kProfileFeatures + 1) / 2;

struct ProfileCell {
  std::array<double, kProfileProducts> products{};  // sum of w x_i x_j, i <= j, row by row
  double observations = 0.0;                        // independent ones
  double weighted_force = 0.0;                      // sum of observations times force [N]

  double product(ProfileFeature a, ProfileFeature b) const noexcept;
  // Product of one feature with a combination of all.
  double product_with(std::size_t feature,
                      const std::array<double, kProfileFeatures>& factors) const noexcept;
};

struct ProfileSums {
  std::array<ProfileCell, kProfileCells> cells{};
  UnloadingTrace unloading{};
  double depth_min_m = 0.0, depth_max_m = 0.0;
  // Sums over observations of added mass / reduced mass, and of its square. The measured acceleration follows
  // from the force that it helps to measure; the density of such a sample has the factor 1 + c m_a / M_f.
  double response = 0.0, response_squared = 0.0;
  double reduced_mass_kg = 0.0;  // M_f
  double last_s = 0.0;           // time since contact of the last sample
  std::int32_t samples = 0;
  std::int32_t saturated = 0;
  std::int32_t too_deep = 0;  // below the last cell
};

// The normal equations of the joint fit on the same samples.
JointSums joint_sums_of(const ProfileSums& sums, const StiffnessConfig& config) noexcept;

// F = k [z + z0 (1 - exp(-z/dz0))], the curve that the robot believes before it has touched the ground.
double believed_force_N(const StiffnessConfig& config, double depth_m) noexcept;
// 1 - exp(-z/dz0)
double intercept_growth(const JointConfig& config, double depth_m) noexcept;

// Adds samples, each at the same small cost. Never allocates.
class ProfileRegression {
 public:
  // `reduced_mass_kg`: what the foot accelerates as, with its leg (estimation/leg.hpp).
  ProfileRegression(const StiffnessConfig& config, double foot_radius_m, double reduced_mass_kg);
  // For every sample of a stance, on new ground or not. False where the accelerometer is at its range or was
  // just before: such a sample does not count.
  bool watch(const JointSample& sample) noexcept;
  // `motor_force_N`: the part of the force that the motors' current gives.
  void add(const JointSample& sample, double motor_force_N) noexcept;
  // Drag and added mass of the believed bed on the foot.
  double inertia_N(const JointSample& sample) const noexcept;
  const ProfileSums& sums() const noexcept { return sums_; }
  void reset() noexcept;

 private:
  StiffnessConfig config_;
  double believed_N_per_m_;
  double reduced_mass_kg_;
  Bed cone_;  // added mass at factor 1
  ProfileSums sums_{};
  double settled_s_ = 0.0;  // after a saturated sample
};

}  // namespace sandhopper
