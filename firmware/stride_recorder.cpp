#include "firmware/stride_recorder.hpp"

#include <algorithm>

namespace sandhopper {

StrideRecorder::StrideRecorder(const StiffnessConfig& config, const Foot& foot)
    : config_(config),
      joint_(config.joint, foot.radius_m),
      profile_(config, foot.radius_m, foot.reduced_mass_kg),
      unloading_(config.min_speed_mps),
      reduced_mass_kg_(foot.reduced_mass_kg),
      events_(ground_event_config(config), foot.radius_m) {}

void StrideRecorder::on_release(std::int64_t now_ns) noexcept {
  current_ = {};
  datum_m_ = deepest_m_ = crater_depth_m_ = surface_z_m_ = 0.0;
  deepest_force_N_ = crater_force_N_ = 0.0;
  leaving_ = rises_ = clear_ = false;
  begin_flight(now_ns);
}

void StrideRecorder::begin_flight(std::int64_t release_ns) noexcept {
  const std::uint32_t stride = current_.stride;
  current_ = {};
  current_.stride = stride;
  current_.release_ns = release_ns;
  current_.crater_depth_m = crater_depth_m_;
  restart_sums();
}

// The foot meets its crater's floor at the depth at which it left it: on the unloading line at zero force.
// This depth is known better than the estimated height after a flight. A contact long before the touchdown
// was a swing of the leg.
void StrideRecorder::take_crater_floor(std::int64_t now_ns) noexcept {
  constexpr std::int64_t kContactToTouchdown_ns = 10'000'000;
  constexpr double kUnloadingRatio = 30.0;  // slope of the unloading line over that of the virgin bed
                                            // (terrain/bed.hpp)
  if (now_ns - current_.contact_ns > kContactToTouchdown_ns) return;
  const double line_N_per_m = kUnloadingRatio * config_.profile_or_default().believed_stiffness_N_per_m;
  datum_m_ = contact_depth_m_ - (crater_depth_m_ - crater_force_N_ / line_N_per_m);
}

void StrideRecorder::on_touchdown(std::int64_t now_ns) noexcept {
  if (current_.stride > 0) take_crater_floor(now_ns);
  ++current_.stride;
  current_.touchdown_ns = now_ns;
}

void StrideRecorder::on_switch(std::int64_t now_ns) noexcept {
  current_.switch_ns = now_ns;
  profile_.on_phase_change(static_cast<double>(last_force_time_ns_ - current_.contact_ns) * 1e-9);
  events_.on_phase_change(event_time_s());
  if (config_.window == SampleWindow::compression) commit();
}

void StrideRecorder::on_liftoff(std::int64_t now_ns) noexcept {
  current_.liftoff_ns = now_ns;
  current_.liftoff_depth_m = -last_foot_z_m_ - datum_m_;
  if (config_.window == SampleWindow::whole_stance) commit();
  done_ = committed_;
  done_.summary = current_;
  done_.profile = profile_.sums();
  done_.profile.unloading = unloading_.trace();
  done_.profile.reduced_mass_kg = reduced_mass_kg_;
  events_.on_phase_change(event_time_s());
  events_.close(current_.stride);
  leaving_ = true;
  rises_ = false;
  // A foot on new ground is at its greatest depth, even if the estimated depth is less than the crater's.
  if (new_deepest_m_ > 0.0) crater_depth_m_ = new_deepest_m_;
  deepest_m_ = crater_depth_m_;
  crater_force_N_ = deepest_force_N_;
  surface_z_m_ = std::min(last_foot_z_m_, 0.0);
  begin_flight(now_ns);
}

void StrideRecorder::update(const Estimate& e, State state) noexcept {
  last_foot_z_m_ = e.foot_z_m;
  sample_duration_s_ = static_cast<double>(e.force_time_ns - last_force_time_ns_) * 1e-9;
  last_force_time_ns_ = e.force_time_ns;
  // A leg can touch down while it still lifts its foot out of the crater. Then the events of the stride begin
  // after the foot was clear. One cycle later, because the samples of the stance before are read first.
  if (clear_ && touched_) begin_events(e);
  clear_ = false;
  if (leaving_) follow_leaving_foot(e);
  if (state == State::flight && still_falling(e)) {
    current_.touchdown_speed_mps = std::max(current_.touchdown_speed_mps, e.force_velocity_mps);
    touched_ = false;
    restart_sums();
    return;
  }
  if (!touched_) {
    touched_ = true;
    current_.contact_ns = e.force_time_ns;
    contact_depth_m_ = e.force_depth_m;
    profile_.on_contact(e.force_velocity_mps, current_.stride > 0);
    if (current_.stride == 0) datum_m_ = e.force_depth_m;
    if (!leaving_) begin_events(e);
  }
  const double depth = e.force_depth_m - datum_m_;
  const bool stance = state == State::compression || state == State::extension;
  if (stance) {
    current_.peak_force_N = std::max(current_.peak_force_N, e.contact_force_N);
    current_.peak_quasi_static_N = std::max(current_.peak_quasi_static_N, e.quasi_static_force_N);
    current_.max_depth_m = std::max(current_.max_depth_m, depth);
    if (state == State::extension) unloading_.add(joint_sample(e, depth, current_.contact_ns));
  }
  const bool falling = state == State::flight && e.force_velocity_mps > 0.0;
  if (stance || falling) accumulate(e, depth);
  if (!leaving_ && (stance || falling)) events_.add(joint_sample(e, depth, event_contact_ns_));
}

void StrideRecorder::begin_events(const Estimate& e) noexcept {
  event_contact_ns_ = e.force_time_ns;
  events_.restart(crater_depth_m_);
}

// After liftoff the ground still acts on the foot until the foot is above the surface or falls again.
void StrideRecorder::follow_leaving_foot(const Estimate& e) noexcept {
  const double depth_m = e.force_depth_m - datum_m_;
  rises_ = rises_ || e.force_velocity_mps < -config_.min_speed_mps;
  clear_ = rises_ && (depth_m < 0.0 || e.force_velocity_mps > 0.0);
  leaving_ = !clear_;
  if (leaving_) events_.add(joint_sample(e, depth_m, event_contact_ns_));
}

double StrideRecorder::event_time_s() const noexcept {
  return static_cast<double>(last_force_time_ns_ - event_contact_ns_) * 1e-9;
}

// Detects contact. In the first flight the foot's accelerometer shows the ground's force as the part beyond
// the leg's own forces. This gives the surface within a fraction of a millimetre, without the height sensor's
// offset and the observer's lag. A later flight begins in the crater while the leg swings back; there the
// greatest downward speed marks contact.
bool StrideRecorder::still_falling(const Estimate& e) const noexcept {
  if (current_.stride == 0) return e.direct_force_N < config_.contact_force_N;
  return e.force_velocity_mps > current_.touchdown_speed_mps;
}

bool StrideRecorder::counts(const Estimate& e, double depth_m) const noexcept {
  switch (config_.window) {
    case SampleWindow::penetrating:
      return e.force_velocity_mps > config_.min_speed_mps;
    case SampleWindow::new_depth:
      return depth_m > deepest_m_;
    default:
      return true;
  }
}

void StrideRecorder::accumulate(const Estimate& e, double depth_m) noexcept {
  // In the old crater the ground follows its unloading line, which gives no information on the virgin bed.
  const bool virgin = depth_m > 0.0 && depth_m >= crater_depth_m_;
  const bool through_stance =
      config_.window == SampleWindow::whole_stance || config_.window == SampleWindow::compression;
  if ((virgin || through_stance) && counts(e, depth_m)) {
    const double weight = acceleration_weight(config_.weights, e.weighting_accel_mps2);
    quasi_static_.add({depth_m, e.quasi_static_force_N, 1.0});
    observer_.add({depth_m, e.contact_force_N, 1.0});
    weighted_.add({depth_m, e.contact_force_N, weight});
  }
  const JointSample sample = joint_sample(e, depth_m, current_.contact_ns);
  const bool settled = profile_.watch(sample);
  // While the foot rests or unloads, drift of the estimated depth can look like new depth. So require a
  // downward speed.
  if (e.force_velocity_mps <= config_.min_speed_mps) {
    rested_ = new_deepest_m_ > 0.0;
    return;
  }
  if (settled && depth_m > new_deepest_m_ && on_new_ground(sample)) {
    profile_.add(sample, e.quasi_static_force_N);
    deepest_force_N_ = sample.force_N - profile_.inertia_N(sample);
    new_deepest_m_ = depth_m;
    rested_ = false;
  }
  if (depth_m <= deepest_m_) return;
  if (virgin) {
    joint_.add(sample);
    // profile_ does not use this sample, but it counts those at the accelerometer's range.
    if (!settled && on_new_ground(sample)) profile_.add(sample, e.quasi_static_force_N);
  }
  deepest_m_ = depth_m;
  if (!through_stance) commit();
}

JointSample StrideRecorder::joint_sample(const Estimate& e, double depth_m,
                                         std::int64_t contact_ns) const noexcept {
  return {.depth_m = depth_m,
          .speed_mps = e.force_velocity_mps,
          .accel_mps2 = -e.foot_accel_mps2,
          .force_N = e.direct_force_N,
          .leg_rate_mps = e.leg_rate_mps,
          .since_contact_s = static_cast<double>(e.force_time_ns - contact_ns) * 1e-9,
          .duration_s = sample_duration_s_};
}

// Near the old crater the estimated depth does not show whether the ground is new. A force at least as large
// as that at the crater's deepest point does. A test of the depth alone would select landings whose depth is
// overestimated. A foot that came to rest and is loaded again moves in its own crater: the spring back by up
// to a millimetre is less than the error of the estimated depth.
bool StrideRecorder::on_new_ground(const JointSample& sample) const noexcept {
  constexpr double kDeviations = 2.0;
  const double crater_m = rested_ ? new_deepest_m_ : crater_depth_m_;
  const double crater_N = rested_ ? deepest_force_N_ : crater_force_N_;
  const double sure_m = crater_m + kDeviations * config_.profile_or_default().landing_depth_sd_m;
  return crater_m == 0.0 || sample.depth_m > sure_m ||
         sample.force_N - profile_.inertia_N(sample) >= crater_N;
}

void StrideRecorder::restart_sums() noexcept {
  committed_.quasi_static_ols = committed_.observer_ols = committed_.observer_wls = {};
  committed_.joint = {};
  profile_.reset();
  quasi_static_.reset();
  observer_.reset();
  weighted_.reset();
  joint_.reset();
  unloading_.reset();
  new_deepest_m_ = 0.0;
  rested_ = false;
}

void StrideRecorder::commit() noexcept {
  committed_.quasi_static_ols = quasi_static_.sums();
  committed_.observer_ols = observer_.sums();
  committed_.observer_wls = weighted_.sums();
  committed_.joint = joint_.sums();
}

StrideRecorder::Foot foot_in_flight(const CycleConfig& config, const Leg& leg) noexcept {
  const double angle_rad = leg.angle_at_length(config.controller.compression_length_m);
  return {config.robot.foot_radius_m, leg.dynamics(angle_rad).reduced_mass_kg};
}

StrideResult solve_stride(const StrideSums& sums, const StiffnessConfig& config) noexcept {
  return {.summary = sums.summary,
          .quasi_static_ols = solve_stiffness(sums.quasi_static_ols, config),
          .observer_ols = solve_stiffness(sums.observer_ols, config),
          .observer_wls = solve_stiffness(sums.observer_wls, config),
          .joint = solve_joint(sums.joint, config)};
}

}  // namespace sandhopper
