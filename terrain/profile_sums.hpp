#pragma once
#include <array>
#include <cstdint>

#include "terrain/bed.hpp"
#include "terrain/joint_fit.hpp"
#include "terrain/profile_config.hpp"
#include "terrain/reloading.hpp"

// Normal equations of the strength profile (strength_profile.hpp), accumulated in the cycle. The depth is
// divided into cells; each stores the weighted products of ten features of its samples. After liftoff the
// solver combines them with any slope of the curve. So the depth error can be a nuisance parameter although
// the slope is not known in advance.
namespace sandhopper {

inline constexpr std::size_t kProfileCells = 28;
inline constexpr double kProfileCell_m = 0.0025;
inline constexpr double kProfileDepth_m = static_cast<double>(kProfileCells) * kProfileCell_m;

// Features of a sample: 1, position in the cell (0 to 1), 1 - exp(-z/dz0), added-mass term (joint_fit.hpp)
// [N], steady drag at lambda = 1 (bed.hpp) [N], time since contact [s], speed minus the speed at contact
// [m/s], direction of joint friction, force from the motors' current [N], and measured force minus the
// believed bed's force [N].
enum class ProfileFeature : std::size_t {
  one,
  place,
  intercept,
  added_mass,
  steady_drag,
  time,
  speed,
  friction,
  motor,
  force
};
inline constexpr std::size_t kProfileFeatures = 10;
inline constexpr std::size_t kProfileProducts = kProfileFeatures * (kProfileFeatures + 1) / 2;

struct ProfileCell {
  std::array<double, kProfileProducts> products{};  // sum of w x_i x_j, i <= j, row by row
  double observations = 0.0;                        // number of independent observations
  double weighted_force = 0.0;                      // sum of observations times force [N]

  double product(ProfileFeature a, ProfileFeature b) const noexcept;
  // Product of one feature with a linear combination of all features.
  double product_with(std::size_t feature,
                      const std::array<double, kProfileFeatures>& factors) const noexcept;
};

struct ProfileSums {
  std::array<ProfileCell, kProfileCells> cells{};
  UnloadingTrace unloading{};
  double depth_min_m = 0.0, depth_max_m = 0.0;
  // Sums over observations of added mass / reduced mass, and of its square. The measured acceleration depends
  // on the force that it helps to measure. So the density of such a sample has the factor 1 + c m_a / M_f.
  double response = 0.0, response_squared = 0.0;
  double reduced_mass_kg = 0.0;                // M_f
  double contact_mps = 0.0;                    // speed at contact; 0: contact was not found by its force
  double contact_added_mass_kg_per_m = 0.0;    // growth of the added mass with the depth at contact
  double last_s = 0.0, last_change_mps = 0.0;  // time and speed of the last sample, relative to the contact
  std::int32_t samples = 0;
  std::int32_t saturated = 0;
  std::int32_t too_deep = 0;  // below the last cell
};

// Normal equations of the joint fit for the same samples.
JointSums joint_sums_of(const ProfileSums& sums, const StiffnessConfig& config) noexcept;

// F = k [z + z0 (1 - exp(-z/dz0))]: the curve that the robot assumes before it has touched the ground.
double believed_force_N(const StiffnessConfig& config, double depth_m) noexcept;
// 1 - exp(-z/dz0)
double intercept_growth(const JointConfig& config, double depth_m) noexcept;

// Steady drag of a flat round foot at lambda = 1, over the square of the speed: rho A.
double steady_drag_kg_per_m(double foot_radius_m) noexcept;

// Adds samples at constant cost. Never allocates.
class ProfileRegression {
 public:
  // `reduced_mass_kg` is the effective mass of foot and leg for the foot's acceleration (estimation/leg.hpp).
  ProfileRegression(const StiffnessConfig& config, double foot_radius_m, double reduced_mass_kg);
  // Call it for every sample of a stance, on new ground or not. Returns false while the accelerometer is
  // saturated, and shortly after that or after a change of the stance's phase; such a sample must not be
  // used.
  bool watch(const JointSample& sample) noexcept;
  // Called at contact, from which the depth counts. A lag l acts on a depth by the change of speed since
  // then: z(t - l) - z(-l) = z(t) - l (v(t) - v(0)). In a crater, drift and lag count from the first sample
  // on new ground instead: the error of a landing is the depth error at that sample.
  void on_contact(double speed_mps, bool in_crater = false) noexcept;
  // Called at the stance switch, between the samples before and after it. The torque steps, and the motors'
  // replies and the measured acceleration follow it with different delays. So the force is wrong by up to the
  // step.
  void on_phase_change(double since_contact_s) noexcept;
  // `motor_force_N` is the part of the force that is calculated from the motors' current.
  void add(const JointSample& sample, double motor_force_N) noexcept;
  // Drag and added-mass force of the believed bed on the foot.
  double inertia_N(const JointSample& sample) const noexcept;
  const ProfileSums& sums() const noexcept { return sums_; }
  void reset() noexcept;

 private:
  StiffnessConfig config_;
  double believed_N_per_m_;
  double reduced_mass_kg_;
  Bed cone_;              // added mass at factor 1
  double drag_kg_per_m_;  // steady drag at lambda = 1, over v^2
  ProfileSums sums_{};
  double start_speed_mps_ = 0.0, start_s_ = 0.0;  // from which lag and drift count
  bool starts_ = false;                           // at the next sample
  double settled_s_ = 0.0;                        // samples before this time since contact are not used
};

}  // namespace sandhopper
