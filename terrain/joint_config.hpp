#pragma once
#include "config/fields.hpp"

namespace sandhopper {

// Priors and noise of the joint fit; joint_fit.hpp defines the symbols.
struct JointConfig {
  double force_noise_N = 0.5;
  double force_scale_relative = 0.02;       // e
  double fluctuation_relative = 0.02;       // epsilon
  double fluctuation_length_m = 0.002;      // ell
  double intercept_growth_depth_m = 0.003;  // dz0
  double intercept_depth_m = 0.003;         // prior mean of z0, then its standard deviation
  double intercept_depth_sd_m = 0.010;
  double added_mass_factor = 1.0;  // prior mean of c, then its standard deviation
  double added_mass_factor_sd = 1.5;
  double surface_sd_m = 0.0007;
  double depth_drift_sd_mps = 0.005;
  double joint_friction_sd_N = 0.4;
  double friction_switch_speed_mps = 0.02;  // v_s
  double accel_range_mps2 = 142.0;          // larger accelerations count as saturated: 97 % of 16 g, minus
                                            // gravity
  int min_observations = 6;                 // least number of independent observations

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("force_noise_N", self.force_noise_N, Range{1e-3, 100.0});
    visit("force_scale_relative", self.force_scale_relative, Range{0.0, 0.5});
    visit("fluctuation_relative", self.fluctuation_relative, Range{0.0, 0.5});
    visit("fluctuation_length_m", self.fluctuation_length_m, Range{1e-5, 0.1});
    visit("intercept_growth_depth_m", self.intercept_growth_depth_m, Range{1e-6, 0.2});
    visit("intercept_depth_m", self.intercept_depth_m, Range{0.0, 0.2});
    visit("intercept_depth_sd_m", self.intercept_depth_sd_m, Range{1e-6, 0.2});
    visit("added_mass_factor", self.added_mass_factor, Range{0.0, 20.0});
    visit("added_mass_factor_sd", self.added_mass_factor_sd, Range{1e-6, 100.0});
    visit("surface_sd_m", self.surface_sd_m, Range{1e-6, 0.1});
    visit("depth_drift_sd_mps", self.depth_drift_sd_mps, Range{1e-6, 1.0});
    visit("joint_friction_sd_N", self.joint_friction_sd_N, Range{1e-6, 100.0});
    visit("friction_switch_speed_mps", self.friction_switch_speed_mps, Range{1e-4, 1.0});
    visit("accel_range_mps2", self.accel_range_mps2, Range{1.0, 1e5});
    visit("min_observations", self.min_observations, Range{3, 1000});
  }
};

}  // namespace sandhopper
