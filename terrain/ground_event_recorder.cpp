#include <algorithm>
#include <cmath>

#include "terrain/ground_events.hpp"

namespace sandhopper {
namespace {

constexpr double kUnknown_m = -1.0;
constexpr double kLeastStep_m = 1e-6;  // step beyond the deepest point, larger than the rounding of its
                                       // single precision

void put(DepthBins& bins, const JointSample& s, double inertia_N, double friction) noexcept {
  const double place = s.depth_m / DepthBins::kWidth_m;
  if (!(place >= 0.0) || place >= static_cast<double>(DepthBins::kBins)) {
    ++bins.out_of_range;
    return;
  }
  auto& b = bins.bin[static_cast<std::size_t>(place)];
  b.samples += 1.0F;
  b.depth_m += static_cast<float>(s.depth_m);
  b.force_N += static_cast<float>(s.force_N);
  b.inertia_N += static_cast<float>(inertia_N);
  b.friction += static_cast<float>(friction);
  b.time_s += static_cast<float>(s.since_contact_s);
  b.speed_mps += static_cast<float>(s.speed_mps);
}

}  // namespace

GroundEventRecorder::GroundEventRecorder(const GroundEventConfig& config, double foot_radius_m)
    : config_(config), cone_(BedParameters{}, foot_radius_m) {}

void GroundEventRecorder::restart(double crater_depth_m) noexcept {
  sums_ = {};
  sums_.crater_depth_m = static_cast<float>(crater_depth_m);
  sums_.deepest_m = sums_.crater_depth_m;
  settled_s_ = 0.0;
  paused_s_ = -1.0;
  pause_N_per_m_ = 0.0;
  bearing_N_ = 0.0;
  new_from_m_ = kUnknown_m;
  shift_m_ = 0.0;
  leaves_ = false;
}

double GroundEventRecorder::inertia_N(const JointSample& s) const noexcept {
  return cone_.added_mass_gradient_kg_per_m(s.depth_m) * s.speed_mps * s.speed_mps +
         cone_.added_mass_kg(s.depth_m) * s.accel_mps2;
}

// Adds the resting foot as a sample at the deepest point, if the ground bore more there than on the last new
// ground before the pause. This is the only sample that shows a crust that breaks at the end of a pause.
void GroundEventRecorder::keep_bearing(const JointSample& s, double deepest_m) noexcept {
  if (!(bearing_N_ > pause_N_per_m_ * deepest_m)) return;
  const JointSample rest{.depth_m = deepest_m,
                         .speed_mps = 0.0,
                         .accel_mps2 = 0.0,
                         .force_N = bearing_N_,
                         .leg_rate_mps = 0.0,
                         .since_contact_s = s.since_contact_s,
                         .duration_s = s.duration_s};
  put(sums_.down, rest, 0.0, 0.0);
}

bool GroundEventRecorder::is_new_ground(const JointSample& s) noexcept {
  const double deepest_m = sums_.deepest_m;
  const double slowing_mps2 = std::max(0.0, -s.accel_mps2);
  if (s.speed_mps < config_.min_speed_mps + slowing_mps2 * config_.speed_lag_s) {
    if (paused_s_ < 0.0) paused_s_ = s.since_contact_s;
    new_from_m_ = kUnknown_m;
    if (std::abs(s.speed_mps) < config_.min_speed_mps && std::abs(s.accel_mps2) < config_.rest_accel_mps2)
      bearing_N_ = std::max(bearing_N_, s.force_N - inertia_N(s));
    return false;
  }
  if (s.since_contact_s < settled_s_) return false;
  if (paused_s_ >= 0.0) {
    constexpr double kDeviations = 2.0;
    const double drift_m = config_.noise.depth_drift_sd_mps * (s.since_contact_s - paused_s_);
    if (new_from_m_ == kUnknown_m) new_from_m_ = deepest_m + kDeviations * drift_m;
    const bool loaded_again = s.force_N - inertia_N(s) >= pause_N_per_m_ * deepest_m;
    if (!loaded_again && s.depth_m <= new_from_m_) return false;
    if (loaded_again) shift_m_ = std::max(0.0, deepest_m - s.depth_m) + kLeastStep_m;
    paused_s_ = -1.0;
    keep_bearing(s, deepest_m);
    sums_.resumed = {
        {{static_cast<float>(s.depth_m + shift_m_), static_cast<float>(bearing_N_)}, sums_.resumed[0]}};
    bearing_N_ = 0.0;
  }
  return s.depth_m + shift_m_ > deepest_m;
}

void GroundEventRecorder::add(const JointSample& sample) noexcept {
  const double friction = std::tanh(sample.leg_rate_mps / config_.noise.friction_switch_speed_mps);
  const bool new_ground = is_new_ground(sample);
  JointSample s = sample;
  s.depth_m += shift_m_;
  if (new_ground) {
    if (leaves_) sums_.up = {};
    leaves_ = false;
    const double inertia = inertia_N(s);
    pause_N_per_m_ = (s.force_N - inertia) / s.depth_m;
    put(sums_.down, s, inertia, friction);
  } else if (s.speed_mps < -config_.min_speed_mps && s.since_contact_s >= settled_s_) {
    leaves_ = true;
    put(sums_.up, s, 0.0, friction);
  }
  sums_.deepest_m = std::max(sums_.deepest_m, static_cast<float>(s.depth_m));
}

}  // namespace sandhopper
