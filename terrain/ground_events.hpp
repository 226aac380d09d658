#pragma once
#include <array>
#include <cstdint>
#include <string_view>

#include "config/fields.hpp"
#include "terrain/joint_fit.hpp"
#include "terrain/strength_profile.hpp"

// Detects sudden changes of the ground in one stance: rupture of a crust, boundary of two layers, floor of
// the box, and suction while the foot leaves. Each is a generalised likelihood-ratio test of a smooth bed
// against a smooth bed plus one template h of unknown place and size A.
//
// Null, for the force y_i at the depths z_i where the foot reached new ground, less the force c A of the
// expected added mass:
//   y = X b + s(z) + (e F) u(z) + n,   all normal with mean zero
//   X   1, z, z^2, 1 - exp(-z/dz0), the cone's drag and added mass A, joint friction, time
//   s   the smooth remainder: squared-exponential covariance with one length
//   u   the bed's fluctuation, triangular covariance over its length; n sensor noise
// With S their covariance, a template's log-likelihood ratio is L(h) = (h' S^-1 y)^2 / (2 h' S^-1 h), and
//   T(h) = v log(1 + 2 L / (v r)),  r = max(1, (y' S^-1 y - 2 L) / v)
// is twice the log-likelihood ratio with the scale of S estimated, too. v is the number of depths minus the
// number of terms of X. Under the null T is chi-squared with one degree of freedom. An event is reported if
// the largest T of all templates exceeds u: M P(chi^2_1 > u) = false_alarm_probability for M templates
// (Bonferroni's bound; half of it if only one sign is an event).
//   rupture   h rises linearly over a length to its place and then decays; A > 0
//   boundary  h = z / (1 + exp((c - z)/w)), either sign
//   floor     h = max(0, z - c); A > 0
//   suction   h = -(27/4) u (1 - u)^2 above the crater's floor, on the samples of the foot that leaves; A > 0
// Mean and variance of c are those of the strength profile after this stride. The profile's curve may jump,
// so a rupture hardly biases its c. If c were free, a wrong c would explain the rupture under a foot that
// rested and then accelerates. In a crater the damping of the landing acts on the first new ground and
// resembles inertia, so c has its prior variance there in addition.
// All templates compete: a rupture is reported only if no other template is more likely. An event that was
// found becomes part of the null of the next search; for a rupture its place is uncertain by one step of the
// search.
//
// A foot that stopped first follows its reloading line, and meanwhile its estimated depth drifts. After a
// pause new ground begins when the force has returned to its value at the deepest point; that point then
// defines the present depth. It also begins when the estimated depth exceeds the deepest point by two
// standard deviations of the drift. The damping of the reloading ends there, which looks like a rupture. So
// within 1 mm of it a rupture is accepted only if the force 1 to 4 mm deeper, less that of the added mass, is
// less than the ground bore under the resting foot in the pause.
//
// Sources: the statistic is that of Davies 1977 (a nuisance parameter that exists only under the
// alternative); the templates are as in terrain/bed_family.hpp.
namespace sandhopper {

enum class GroundEventKind : std::uint8_t { none, crust_rupture, layer_boundary, box_floor, suction };
template <>
struct EnumNames<GroundEventKind> {
  static constexpr std::array<std::string_view, 5> value{"none", "crust_rupture", "layer_boundary",
                                                         "box_floor", "suction"};
};

struct GroundEventConfig {
  double false_alarm_probability = 0.002;  // for each kind, per stride on a smooth bed
  double smooth_length_m = 0.020;          // correlation length of s, for boundary and floor
  double smooth_relative = 0.10;           // standard deviation of s relative to the greatest force
  double rupture_smooth_length_m = 0.005;  // correlation length of s for a rupture; a bed without a rupture
                                           // has no shorter feature
  double rupture_smooth_relative = 0.10;
  double depth_noise_m = 1e-4;  // scatter of the estimated depth; on a steep bed it causes force noise
  double offset_sd_N = 1.0;     // error of the force on a foot in the air: constant part and smooth part
  // Settling time after a change of the stance's phase. The torque steps, and the measured foot acceleration
  // follows it after the age of a reading, one cycle, and three time constants of the IMU's 400 Hz low-pass.
  // Three samples are not used.
  double settling_time_s = 0.003;
  JointConfig noise{};  // force_noise_N, fluctuation and its length, dz0, friction
  // The foot counts as moving above two standard deviations of its estimated speed plus the change of speed
  // within speed_lag_s (one cycle and one time constant of the IMU's low-pass).
  double min_speed_mps = 0.06;
  double speed_lag_s = 0.0014;
  // Largest acceleration of a resting foot: three standard deviations of its accelerometer under load. A foot
  // that accelerates more may be held by damping, which is no strength of the ground.
  double rest_accel_mps2 = 0.9;

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("false_alarm_probability", self.false_alarm_probability, Range{1e-9, 0.5});
    visit("smooth_length_m", self.smooth_length_m, Range{1e-3, 0.2});
    visit("smooth_relative", self.smooth_relative, Range{0.0, 10.0});
    visit("rupture_smooth_length_m", self.rupture_smooth_length_m, Range{1e-3, 0.2});
    visit("rupture_smooth_relative", self.rupture_smooth_relative, Range{0.0, 10.0});
    visit("depth_noise_m", self.depth_noise_m, Range{0.0, 0.01});
    visit("offset_sd_N", self.offset_sd_N, Range{0.0, 100.0});
    visit("settling_time_s", self.settling_time_s, Range{0.0, 0.1});
    visit("noise", self.noise);
    visit("min_speed_mps", self.min_speed_mps, Range{0.0, 1.0});
    visit("speed_lag_s", self.speed_lag_s, Range{0.0, 0.1});
    visit("rest_accel_mps2", self.rest_accel_mps2, Range{1e-3, 100.0});
  }
};

struct GroundEvent {
  GroundEventKind kind = GroundEventKind::none;
  double depth_m = 0.0;    // below the surface
  double force_N = 0.0;    // force on the foot at this depth
  double speed_mps = 0.0;  // speed of the foot there, downward positive
  double size = 0.0;       // A [N]; for a boundary or a floor [N/m]
  double size_sd = 0.0;
  double statistic = 0.0;  // T
  double threshold = 0.0;  // u

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("kind", self.kind);
    visit("depth_m", self.depth_m);
    visit("force_N", self.force_N);
    visit("speed_mps", self.speed_mps);
    visit("size", self.size);
    visit("size_sd", self.size_sd);
    visit("statistic", self.statistic);
    visit("threshold", self.threshold);
  }
};

// Sums of the force and its regressors over bins of depth, for one direction of the foot's motion.
struct DepthBins {
  static constexpr std::size_t kBins = 160;
  static constexpr double kWidth_m = 5e-4;  // 80 mm in total; deeper samples are left out and counted
  struct Bin {
    float samples = 0.0F, depth_m = 0.0F, force_N = 0.0F, inertia_N = 0.0F, friction = 0.0F, time_s = 0.0F,
          speed_mps = 0.0F;  // sums
  };
  std::array<Bin, kBins> bin{};
  std::int32_t out_of_range = 0;
};

// Samples of one stance that the cycle stores. Of bounded size; copied to the thread that searches.
struct GroundEventSums {
  DepthBins down;  // foot moving down on new ground
  DepthBins up;    // foot leaving
  std::uint32_t stride = 0;
  float deepest_m = 0.0F;
  float crater_depth_m = 0.0F;  // of earlier strides
  struct Resumption {
    float depth_m = -1.0F;   // depth at which new ground began after a pause; negative: none
    float bearing_N = 0.0F;  // greatest force on the resting foot in that pause: a lower bound of the
                             // ground's strength there
  };
  std::array<Resumption, 2> resumed{};  // the latest first
};

// Accumulates the samples of a stance and those after liftoff until the foot is clear of its crater. Never
// allocates.
class GroundEventRecorder {
 public:
  GroundEventRecorder(const GroundEventConfig& config, double foot_radius_m);
  // Starts a new stride. crater_depth_m is the deepest point of the earlier ones.
  void restart(double crater_depth_m) noexcept;
  // Called at liftoff with the number of the stride that these samples belong to.
  void close(std::uint32_t stride) noexcept { sums_.stride = stride; }
  // Called at the stance switch and at liftoff, between the samples before and after it.
  void on_phase_change(double since_contact_s) noexcept {
    settled_s_ = since_contact_s + config_.settling_time_s;
  }
  void add(const JointSample& sample) noexcept;
  const GroundEventSums& sums() const noexcept { return sums_; }

 private:
  bool is_new_ground(const JointSample& sample) noexcept;
  void keep_bearing(const JointSample& sample, double deepest_m) noexcept;
  double inertia_N(const JointSample& sample) const noexcept;

  GroundEventConfig config_;
  Bed cone_;  // added mass at factor 1
  GroundEventSums sums_{};
  double settled_s_ = 0.0;
  double paused_s_ = -1.0;  // time since contact at which the foot stopped going down; negative: it goes down
  double pause_N_per_m_ =
      0.0;  // force without added-mass force divided by depth, on the last new ground before the pause
  double bearing_N_ = 0.0;   // greatest force on the resting foot since the pause began
  double new_from_m_ = 0.0;  // depth beyond which the ground counts as new after the pause
  double shift_m_ = 0.0;     // correction of the estimated depth since the last pause
  bool leaves_ = false;      // sums_.up contains samples
};

struct GroundEvents {
  std::uint32_t stride = 0;
  GroundEvent rupture{};   // kind none: not found; `statistic` is then the largest value
  GroundEvent boundary{};  // layer boundary or floor
  GroundEvent suction{};

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("stride", self.stride);
    visit("rupture", self.rupture);
    visit("boundary", self.boundary);
    visit("suction", self.suction);
  }
};

// Default configuration with the noise of the joint fit.
GroundEventConfig ground_event_config(const StiffnessConfig& config) noexcept;

// `profile`: estimate from all strides to this one, for its added mass. Without a stride the added mass has
// the prior of the joint fit. Not for the cycle: it takes some ten milliseconds for the full range of depth,
// and it allocates. Equal sums and profiles give equal bits.
GroundEvents find_ground_events(const GroundEventSums& sums, const GroundEventConfig& config,
                                const StrengthProfile& profile = {});

// u with P(chi^2_1 > u) = probability.
double chi_squared_1_quantile(double probability) noexcept;

}  // namespace sandhopper
