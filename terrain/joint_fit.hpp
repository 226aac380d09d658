#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "config/fields.hpp"
#include "terrain/bed.hpp"
#include "terrain/joint_config.hpp"
#include "terrain/stiffness_fit.hpp"

// Stiffness of the ground from force, depth, speed and acceleration together. The straight line of
// stiffness_fit.hpp attributes the drag and the added mass at touchdown to the stiffness; this fit does not.
// On samples that penetrate virgin ground (depth z, speed v down, zdd = dv/dt),
//   F = k z + k z0 (1 - exp(-z/dz0)) + c [m_a'(z) v^2 + m_a(z) zdd] + k d + k r t + f tanh(Ldot / v_s)
//   k   stiffness [N/m]                       z0  intercept depth [m], >= 0
//   c   added-mass factor [-], >= 0: drag is the gradient of the added mass (bed.hpp), so both share it
//   d   error of the surface's height [m]     r   drift of the estimated depth [m/s], t since contact
//   f   joint friction as it appears at the foot [N]
// by weighted least squares with a normal prior on everything except k. A sample's weight is its share of new
// ground, v dt / ell (at most 1), over sigma_F^2 + (epsilon F)^2. So the bed's own fluctuation over one
// correlation length ell is one observation, however long the foot takes. F must not lag behind z. Therefore
// it is the force from the foot's accelerometer, not the observer's.
// The interval is value +- t s, s^2 = max(chi^2, 1) cov_kk + (e k)^2. e is the relative error of the force
// scale (torque constant), t Student's quantile for the number of independent observations.
// Sources: cone as in bed.hpp (Aguilar & Goldman 2016). The joint regression was developed in this project.
namespace sandhopper {

struct JointSample {
  double depth_m;
  double speed_mps;   // down positive
  double accel_mps2;  // down positive
  double force_N;
  double leg_rate_mps;  // dL/dt of the leg's length
  double since_contact_s;
  double duration_s;  // time since the previous sample
};

enum class JointTerm : std::size_t { stiffness, intercept, added_mass, surface, drift, friction };
inline constexpr std::size_t kJointTerms = 6;

// Normal equations of one stance. Of bounded size; copied from the cycle to the thread that solves them.
struct JointSums {
  std::array<double, kJointTerms * kJointTerms> normal{};
  std::array<double, kJointTerms> moment{};
  double force_squared = 0.0;  // sum of w F^2
  double observations = 0.0;   // number of independent observations
  double depth_min_m = 0.0, depth_max_m = 0.0;
  std::int32_t samples = 0;
  std::int32_t saturated = 0;
};

// Accumulates samples at constant cost. Never allocates.
class JointRegression {
 public:
  JointRegression(const JointConfig& config, double foot_radius_m);
  void add(const JointSample& sample) noexcept;
  const JointSums& sums() const noexcept { return sums_; }
  void reset() noexcept { sums_ = {}; }

 private:
  JointConfig config_;
  Bed cone_;  // added mass at factor 1
  JointSums sums_{};
};

struct JointEstimate {
  double value_N_per_m = 0.0;
  double standard_error_N_per_m = 0.0;
  double ci95_low_N_per_m = 0.0;
  double ci95_high_N_per_m = 0.0;
  double intercept_depth_m = 0.0;
  double added_mass_factor = 0.0;
  double added_mass_factor_sd = 0.0;
  double depth_drift_mps = 0.0;
  double joint_friction_N = 0.0;
  double chi_squared = 0.0;  // chi-squared per degree of freedom
  double observations = 0.0;
  std::int32_t samples = 0;
  Validity validity = Validity::too_few_samples;

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("value_N_per_m", self.value_N_per_m);
    visit("standard_error_N_per_m", self.standard_error_N_per_m);
    visit("ci95_low_N_per_m", self.ci95_low_N_per_m);
    visit("ci95_high_N_per_m", self.ci95_high_N_per_m);
    visit("intercept_depth_m", self.intercept_depth_m);
    visit("added_mass_factor", self.added_mass_factor);
    visit("added_mass_factor_sd", self.added_mass_factor_sd);
    visit("depth_drift_mps", self.depth_drift_mps);
    visit("joint_friction_N", self.joint_friction_N);
    visit("chi_squared", self.chi_squared);
    visit("observations", self.observations);
    visit("samples", self.samples);
    visit("validity", self.validity);
  }
};

// Solves the normal equations. The limits of depth and depth span are those of the straight line's
// configuration.
JointEstimate solve_joint(const JointSums& sums, const StiffnessConfig& config) noexcept;

// One stiffness from several strides on beds prepared alike: the mean of a normal population of beds, whose
// spread is estimated (DerSimonian & Laird 1986). The force-scale error is common to all strides of a robot
// and does not average out.
struct PooledStiffness {
  double value_N_per_m = 0.0;
  double ci95_low_N_per_m = 0.0;  // interval of the mean
  double ci95_high_N_per_m = 0.0;
  double between_strides_sd_N_per_m = 0.0;
  int strides = 0;
};
PooledStiffness pool_strides(std::span<const JointEstimate> strides, const JointConfig& config);

// Student's 97.5 % quantile for `degrees` of freedom >= 1 (Cornish-Fisher expansion, within 0.5 % from 3 on).
double student_975(double degrees) noexcept;

}  // namespace sandhopper
