#pragma once
#include "config/fields.hpp"

namespace sandhopper {

// Time constant of the foot's accelerometer: its low-pass at 400 Hz, a quarter of its rate
// (config/linux.toml).
inline constexpr double kAccelLowPass_s = 0.0004;

// Prior of the strength profile (strength_profile.hpp); noise and nuisances are those of the joint fit.
struct ProfileConfig {
  // Expected tangent stiffness of the bed, and the standard deviation of the real one relative to it. The
  // credible range of loose to compacted glass beads is 1000 to 3600 N/m.
  double believed_stiffness_N_per_m = 1500.0;
  double stiffness_spread_relative = 0.7;
  // Standard deviation of the steady drag coefficient lambda (bed.hpp). The believed bed has none; drag that
  // persists at depth is in doubt, and values up to 1 are reported.
  double steady_drag_sd = 0.5;
  // Standard deviation of the strength between places prepared alike: 3 % between trials on poured glass
  // beads. That of the layer at the surface is integrated over a grid from a quarter to four times this
  // value.
  double place_strength_sd_relative = 0.03;
  // Depth at contact (strength_profile.hpp). The mean force at which contact is found is less than the
  // threshold by `contact_early_N`, because the first of several noisy samples exceeds it. The depth belongs
  // to the motors' reply, and the accelerometer can feel the blow after it: in the mean the depth is
  // `contact_time_s` after the time at which the low-passed force exceeds the threshold, which is negative.
  // `hop experiment beds` prints what remains of that time; the others are means and standard deviations in
  // 1200 simulated first strides on each of six families.
  double contact_early_N = 0.3;
  double contact_force_sd_N = 0.25;
  double contact_time_s = -0.00024;
  double contact_time_sd_s = 0.00034;
  // Other errors of the estimated depth in a first stride: of the surface, the Kalman filter's error s_x and
  // its decay a, the lag, and the rest. a is that of the filter with the noise of config/robot.toml. The
  // others are the maximum likelihood in simulated strides on nine families of beds.
  double surface_sd_m = 0.0001;
  // The part of the depth at contact that all places share: root mean square of its mean difference from the
  // expected one in simulated first strides, over nine families of beds and five classes of speed.
  double shared_surface_sd_m = 0.00012;
  double filter_sd_m = 0.0008;
  double filter_decay_per_s = 5.1;
  // Mean: the accelerometer's sample is newer than the motors' reply, to which the depth belongs.
  double depth_lag_s = 0.0003;
  double depth_lag_sd_s = 0.00013;  // 0.18 ms about zero, of which 0.12 ms is the mean
  double depth_noise_m = 0.00002;
  // Error of the depth when a foot lands in its crater, in addition to the error of the crater's depth. It is
  // the root mean square of simulated landings on nine families of beds, 0.8 to 1.0 mm (`hop experiment
  // beds`, column `landing`).
  double landing_depth_sd_m = 0.0009;

  // Noise of one sample of the foot's accelerometer under load, and its remaining bias after the zero at
  // arming. Used for the line on which the foot leaves its crater (reloading.hpp).
  double foot_accel_noise_mps2 = 0.3;
  double foot_accel_bias_mps2 = 0.1;

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("believed_stiffness_N_per_m", self.believed_stiffness_N_per_m, Range{1.0, 1e6});
    visit("stiffness_spread_relative", self.stiffness_spread_relative, Range{0.01, 10.0});
    visit("steady_drag_sd", self.steady_drag_sd, Range{1e-6, 100.0});
    visit("place_strength_sd_relative", self.place_strength_sd_relative, Range{1e-6, 10.0});
    visit("contact_early_N", self.contact_early_N, Range{0.0, 100.0});
    visit("contact_force_sd_N", self.contact_force_sd_N, Range{0.0, 100.0});
    visit("contact_time_s", self.contact_time_s, Range{-0.01, 0.01});
    visit("contact_time_sd_s", self.contact_time_sd_s, Range{0.0, 0.01});
    visit("surface_sd_m", self.surface_sd_m, Range{1e-6, 0.1});
    visit("shared_surface_sd_m", self.shared_surface_sd_m, Range{0.0, 0.1});
    visit("filter_sd_m", self.filter_sd_m, Range{1e-9, 0.1});
    visit("filter_decay_per_s", self.filter_decay_per_s, Range{0.01, 1000.0});
    visit("depth_lag_s", self.depth_lag_s, Range{-0.01, 0.01});
    visit("depth_lag_sd_s", self.depth_lag_sd_s, Range{1e-6, 0.01});
    visit("depth_noise_m", self.depth_noise_m, Range{0.0, 0.01});
    visit("landing_depth_sd_m", self.landing_depth_sd_m, Range{0.0, 0.1});
    visit("foot_accel_noise_mps2", self.foot_accel_noise_mps2, Range{1e-4, 100.0});
    visit("foot_accel_bias_mps2", self.foot_accel_bias_mps2, Range{1e-6, 10.0});
  }
};

}  // namespace sandhopper
