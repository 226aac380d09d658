#pragma once
#include <array>
#include <cstdint>
#include <string_view>

#include "config/fields.hpp"
#include "terrain/joint_fit.hpp"

// Sudden changes of the ground in one stance: rupture of a crust, boundary of two layers, floor of the box,
// and suction while the foot leaves. Each is a generalised likelihood-ratio test of a smooth bed against a
// smooth bed plus one template h of unknown place and size A.
//
// Null, for the force y_i at the depths z_i where the foot reached new ground:
//   y = X b + s(z) + (e F) u(z) + n,   all normal with mean zero
//   X   1, z, z^2, 1 - exp(-z/dz0), the cone's drag and added mass, joint friction, time
//   s   what is smooth beyond that: squared-exponential covariance with one length
//   u   the bed's fluctuation, triangular covariance over its length; n sensor noise
// With S their covariance, a template's log-likelihood ratio is L(h) = (h' S^-1 y)^2 / (2 h' S^-1 h), and
//   T(h) = v log(1 + 2 L / (v r)),  r = max(1, (y' S^-1 y - 2 L) / v)
// is twice its logarithm with the scale of S estimated too, v the number of depths less that of the terms of
// X. Under the null T is chi-squared with one degree of freedom. An event is reported where the largest T of
// all templates exceeds u: M P(chi^2_1 > u) = false_alarm_probability for M templates (Bonferroni's bound;
// half of it where only one sign is an event).
//   rupture   h rises linearly over a length to its place and then decays; A > 0
//   boundary  h = z / (1 + exp((c - z)/w)), either sign
//   floor     h = max(0, z - c); A > 0
//   suction   h = -(27/4) u (1 - u)^2 above the crater's floor, on the samples of the foot that leaves; A > 0
// All templates compete: a rupture is reported where none of the others is likelier. What was found belongs
// to the null of what is looked for next, a rupture with its place in doubt by one step of the search.
//
// A foot that stopped meets its reloading line first, and its estimated depth drifts meanwhile. After a
// pause, new ground begins where the force is again what it was at the deepest point, which is then the
// present depth; or where the depth is greater than before by two standard deviations of that drift. The
// damping of the reloading ends there, which looks like a rupture: within 1 mm of it a rupture must leave
// less force, 1 to 4 mm deeper, than the ground bore under the resting foot in the pause.
//
// Sources: the statistic is Davies 1977 (a nuisance parameter that exists only under the alternative);
// templates as in terrain/bed_family.hpp.
namespace sandhopper {

enum class GroundEventKind : std::uint8_t { none, crust_rupture, layer_boundary, box_floor, suction };
template <>
struct EnumNames<GroundEventKind> {
  static constexpr std::array<std::string_view, 5> value{"none", "crust_rupture", "layer_boundary",
                                                         "box_floor", "suction"};
};

struct GroundEventConfig {
  double false_alarm_probability = 0.002;  // of each kind, per stride on a smooth bed
  double smooth_length_m = 0.020;          // of s, for boundary and floor
  double smooth_relative = 0.10;           // standard deviation of s over the greatest force
  double rupture_smooth_length_m = 0.005;  // of s, for a rupture: a bed without one has no shorter feature
  double rupture_smooth_relative = 0.10;
  double depth_noise_m = 1e-4;  // scatter of the estimated depth; a steep bed makes force of it
  double offset_sd_N = 1.0;     // of the force on a foot in the air, constant and smooth
  // After a change of the stance's phase the torque is another one at once, and the foot's acceleration
  // follows it by the age of a reading, one cycle, and three time constants of the IMU's low-pass of 400 Hz:
  // three samples that do not count.
  double settling_time_s = 0.003;
  JointConfig noise{};  // force_noise_N, fluctuation and its length, dz0, friction
  // A foot is taken to move beyond two standard deviations of its estimated speed, and beyond what its
  // acceleration changes in one cycle and one time constant of the IMU's low-pass.
  double min_speed_mps = 0.06;
  double speed_lag_s = 0.0014;
  // A resting foot accelerates by less than three standard deviations of its accelerometer under load. One
  // that accelerates may be held by damping that is no strength of the ground.
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
  double depth_m = 0.0;    // under the surface
  double force_N = 0.0;    // on the foot there
  double speed_mps = 0.0;  // of the foot there, down positive
  double size = 0.0;       // A: N; N/m for a boundary and a floor
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

// Means of force and what explains it over bins of depth, of one way of the foot.
struct DepthBins {
  static constexpr std::size_t kBins = 160;
  static constexpr double kWidth_m = 5e-4;  // 80 mm altogether; deeper samples are left out and counted
  struct Bin {
    float samples = 0.0F, depth_m = 0.0F, force_N = 0.0F, inertia_N = 0.0F, friction = 0.0F, time_s = 0.0F,
          speed_mps = 0.0F;  // sums
  };
  std::array<Bin, kBins> bin{};
  std::int32_t out_of_range = 0;
};

// The samples of one stance that the cycle keeps: bounded, copied as it is to the thread that searches.
struct GroundEventSums {
  DepthBins down;  // new ground
  DepthBins up;    // the foot leaves
  std::uint32_t stride = 0;
  std::int64_t liftoff_ns = 0;
  float deepest_m = 0.0F;
  float crater_depth_m = 0.0F;  // of earlier strides
  struct Resumption {
    float depth_m = -1.0F;   // where new ground began after a pause; negative: none
    float bearing_N = 0.0F;  // greatest force of the foot at rest in that pause: what the ground bore there
  };
  std::array<Resumption, 2> resumed{};  // the last one first
};

// Accumulates the samples of a stance, and those after liftoff until the foot is clear. Never allocates.
class GroundEventRecorder {
 public:
  GroundEventRecorder(const GroundEventConfig& config, double foot_radius_m);
  // A new stride: the deepest point of the earlier ones.
  void restart(double crater_depth_m) noexcept;
  // The liftoff: the number and time of the stride that these samples belong to.
  void close(std::uint32_t stride, std::int64_t liftoff_ns) noexcept {
    sums_.stride = stride;
    sums_.liftoff_ns = liftoff_ns;
  }
  // The stance switch or the liftoff, between the samples before and after it.
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
  double paused_s_ = -1.0;  // since when the foot has not gone down; negative: it does
  double pause_N_per_m_ =
      0.0;  // force without the added mass's, over depth, on the last new ground before the pause
  double bearing_N_ = 0.0;   // greatest force of the foot at rest since then
  double new_from_m_ = 0.0;  // where new ground begins at the latest after the pause
  double shift_m_ = 0.0;     // added to the estimated depth since then
  bool leaves_ = false;      // sums_.up has samples
};

struct GroundEvents {
  std::uint32_t stride = 0;
  GroundEvent rupture{};   // kind none: not found; its statistic is the largest there was
  GroundEvent boundary{};  // or floor
  GroundEvent suction{};

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("stride", self.stride);
    visit("rupture", self.rupture);
    visit("boundary", self.boundary);
    visit("suction", self.suction);
  }
};

// The search with the noise of the joint fit.
GroundEventConfig ground_event_config(const StiffnessConfig& config) noexcept;

// Not for the cycle: some ten milliseconds for a whole foot of depth, and it allocates. The same sums give
// the same bits.
GroundEvents find_ground_events(const GroundEventSums& sums, const GroundEventConfig& config);

// u with P(chi^2_1 > u) = probability.
double chi_squared_1_quantile(double probability) noexcept;

}  // namespace sandhopper
