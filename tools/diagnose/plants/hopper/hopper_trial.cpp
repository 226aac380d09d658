#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/diagnose/plants/hopper/hopper_belief.hpp"
#include "tools/diagnose/plants/hopper/hopper_trial_model.hpp"

namespace sandhopper::diagnose::hopper {
namespace {

constexpr std::size_t kMostKnots = 16;  // most knots of the bed's fluctuation along depth
constexpr std::size_t kRunsKept = 6;    // runs of each hop in the cache
constexpr double kDeepest_m = 0.048;    // greatest depth that the knots cover
constexpr double kMargin = 1.5;         // the knots cover this many times the depth of the believed run
// Least standard deviations of the surface and of the release.
constexpr double kSurfaceUnknown_m = 3e-4;
constexpr double kReleaseUnknown_m = 2e-4;
constexpr double kReleaseSpeedUnknown_mps = 1e-3;
constexpr double kReleaseAngleUnknown_rad = 2e-4;
constexpr double kNearEndStop_rad = 0.04;  // rows end when the leg is nearer to its end stop
constexpr double kAtLimit = 0.999;         // of the torque limit: a command from here on is clamped
constexpr double kAloft_s = 0.02;          // a contact later than this after liftoff is the next landing
// Factor on the steps of derivatives. A jump at an event is small compared with the change over such a wide
// step, but not compared with the change over the original step.
constexpr double kWideStep = 4.0;

// Standard deviation of each sample relative to one whose time is known. `age_sd_s`: standard deviation of
// its age.
std::vector<double> unsure_of_time(const Samples& samples, double age_sd_s) {
  const auto& [t, v] = samples;
  std::vector<double> relative(v.size(), 1.0);
  const double noise = fluctuation_rms(samples);
  if (age_sd_s <= 0.0 || noise <= 0.0) return relative;
  for (std::size_t i = 1; i < v.size(); ++i) {
    const double moved = age_sd_s * std::abs(v[i] - v[i - 1]) / (t[i] - t[i - 1]) / noise;
    for (const std::size_t k : {i - 1, i}) relative[k] = std::max(relative[k], std::hypot(1.0, moved));
  }
  return relative;
}

}  // namespace

HopperTrial::HopperTrial(const Trial& trial, const Belief& belief)
    : belief_(with_payload(belief, trial)), world_(world_of(belief_, {})), edited_world_(world_) {
  name = trial.name;
  const Leg leg(world_.robot.leg);
  bed_history_ = {trial.setup_or("pushes_since_preparation", 0.0), trial.setup_or("wait_s", 0.0),
                  trial.setup_or("bed_depth_m", 0.0)};
  compression_stiffness_ = trial.setup_or("compression_stiffness_N_per_m", 375.0);
  course_ = course_of(trial, leg, world_.controller.compression_length_m);
  if (course_.hops.empty()) return;
  phases_at_cycles_ = at_cycles(course_, 1.0 / world_.controller.rate_Hz);
  end_before_end_stop(trial);
  const auto temperature = mean_of_motors(trial, "temperature_C");
  for (const double t : temperature.value)
    motor_temperature_C_ += (t - kRoom_C) / static_cast<double>(temperature.value.size());
  if (world_.terrain.rigid || course_.phases.empty()) {
    take_commands(trial);
  } else {
    controller_ = RecordedController(trial, leg, world_, course_.end_s);
    controller_.find_age(world_, compression_stiffness_, course_.phases);
    has_late_commands_ = controller_.age_s() > 0.0 && currents_follow_own_row(trial);
    if (has_late_commands_) return;
    residual_ = controller_.residual_Nm(world_, compression_stiffness_, course_.phases);
  }
  blocks = static_cast<std::uint32_t>(course_.hops.size());
  runs_ = HopperRuns(kRunsKept * blocks);
  add_nuisances();
  end_before_next_landing();
  if (blocks == 1 && !residual_.values.empty()) {
    const auto run = simulate_hopper(run_of(world_, 0, std::vector<double>(nuisance_count(), 0.0)), {});
    controller_.smooth_about(run.angle_rad, run.rate_radps);
    residual_ = controller_.residual_Nm(world_, compression_stiffness_, course_.phases);
  }
  for (std::size_t c = 0; c < kSources.size(); ++c) add_rows(trial, c);
  if (!rows.empty()) label_rows();
}

void HopperTrial::take_commands(const Trial& trial) {
  const auto commands = commands_of(trial);
  if (commands.empty()) return;
  commands_ = on_grid(commands, 0.0, kTick_s, static_cast<std::size_t>(course_.end_s / kTick_s) + 2, true);
}

void HopperTrial::add_nuisances() {
  const auto& s = world_.spread;
  // `least`: lower bound of the standard deviation.
  const auto add = [&](const std::string& what, double believed_sd, double least, double step,
                       const char* port = "") {
    trial_nuisances.push_back(
        {what, std::max(believed_sd, least), kWideStep * step, port, believed_sd > least});
  };
  add("bed_stiffness_relative", s.bed_stiffness_relative, 1e-3, kStiffnessStep / kWideStep, "ground");
  add("release_height_m", s.release_height_m, kReleaseUnknown_m, 1e-5);
  add("release_speed_mps", s.release_speed_mps, kReleaseSpeedUnknown_mps, 1e-4);
  add("release_angle_rad", 0.0, kReleaseAngleUnknown_rad, 1e-5);
  add("surface_height_m", s.surface_height_m, kSurfaceUnknown_m, 1e-5);
  add("cable_force_N", s.cable_force_N, 1e-3, 0.01, "rail");
  add("torque_constant_relative", s.torque_constant_relative, 1e-3, 1e-3);
  add("tof_bias_m", s.tof_bias_m, 1e-4, 1e-3);
  add("imu_bias_mps2", s.imu_bias_mps2, 1e-3, 1e-2);
  add("imu_bias_mps2", s.imu_bias_mps2, 1e-3, 1e-2);
  add("imu_scale_relative", s.imu_scale_relative, 1e-4, 1e-2);
  add("imu_scale_relative", s.imu_scale_relative, 1e-4, 1e-2);
  add("current_offset_A", s.current_offset_A, 1e-3, 1e-2);
  add("current_offset_A", s.current_offset_A, 1e-3, 1e-2);
  add("load_cell_offset_N", s.load_cell_offset_N, 0.02, 0.05);
  trial_nuisances[kTorqueConstant].shared_as = "actuator.torque_constant";
  trial_nuisances[kTorqueConstant].like = {{"actuator.torque_constant", 1.0},
                                           {"actuator.temperature", kRoom_C - motor_temperature_C_}};
  for (const auto c : {kImuBody, kImuFoot})
    trial_nuisances[*kSources[c].scale].shared_as = std::string("imu.scale[") + kSources[c].channel + "]";
  for (const char* sensor : {"tof", "load_cell", "mocap"})
    add(std::string(sensor) + "_sample_age_share", 0.0, kAgeShareUnknown, 0.05);
  if (s.bed_fluctuation_relative > 0.0 && !world_.terrain.rigid) {
    const double deepest_m = std::min(kDeepest_m, kMargin * deepest_believed_m());
    grains_ = BedGrains(s.bed_fluctuation_relative, s.bed_fluctuation_length_m, deepest_m,
                        kDeepest_m / static_cast<double>(kMostKnots - 1), kMostKnots);
    for (std::size_t i = 0; i < grains_.count(); ++i)
      add("bed_fluctuation", grains_.sd(), 0.0, 1e-3, "ground");
  }
  if (blocks > 1 || !course_.hops.front().at_rest)
    block_nuisances = {{"foot_z_m", 0.010, 1e-5},
                       {"foot_velocity_mps", 0.15, 1e-4},
                       {"angle_rad", 0.02, 1e-4},
                       {"rate_radps", 1.0, 1e-3},
                       {"crater_depth_m", 0.005, 1e-5}};
}

double HopperTrial::deepest_believed_m() const {
  double lowest_m = 0.0;
  for (std::uint32_t b = 0; b < blocks; ++b)
    for (const double z :
         simulate_hopper(run_of(world_, b, std::vector<double>(kFirstKnot + blocks * kHopNuisances, 0.0)), {})
             .foot_z_m.values)
      lowest_m = std::min(lowest_m, z);
  return -lowest_m;
}

double HopperTrial::rate_Hz(std::size_t c) const {
  const auto& sensors = world_.sensors;
  return c == kTof        ? sensors.tof_rate_Hz
         : c == kLoadCell ? sensors.load_cell_rate_Hz
         : c > kLoadCell  ? sensors.mocap_rate_Hz
                          : 0.0;
}

double HopperTrial::period_within_rows_s(std::size_t c, double step_s) const {
  if (!is_accelerometer(c)) return 0.0;
  const double rate_Hz = belief_.value("sensors.imu_rate_Hz");
  return rate_Hz * step_s > 1.01 && imu_rate_is_stated(belief_) ? 1.0 / rate_Hz : 0.0;
}

double HopperTrial::imu_settling_s(double period_s) const {
  const auto& s = world_.sensors;
  const double apart = world_.gravity_mps2 / std::max(s.imu_noise_mps2, s.imu_resolution_mps2);
  const double time_constant_s =
      s.imu_bandwidth_Hz > 0.0 ? 0.5 / (std::numbers::pi * s.imu_bandwidth_Hz) : 0.0;
  return period_s + (apart > 1.0 ? time_constant_s * std::log(apart) : 0.0);
}

void HopperTrial::add_rows(const Trial& trial, std::size_t c) {
  sensors_[c] = sensor_belief(belief_, kSources[c].sensor, kSources[c].unit);
  spans_[c].assign(blocks, {});
  // The commands of a hold are not predicted, because the believed controller is that of a hop. They are not
  // predicted without a recorded speed either: a command is exact to its digits, so it would show the
  // smallest error of the simulated speed.
  if (is_command(c) && (trial.kind == "hold" || !controller_.measured())) return;
  const auto samples = samples_of(trial, kSources[c].channel);
  if (samples.value.size() < 10) return;
  auto ages = ages_s(trial, kSources[c].channel, rate_Hz(c));
  const double step_s = median_step_s(samples.time_s);
  const double period_s = period_within_rows_s(c, step_s);
  if (ages.size() != samples.value.size()) ages.assign(samples.value.size(), 0.5 * period_s);
  const std::size_t every = step_s < 1.5e-3 ? kSources[c].every : 1;
  const auto unsure = unsure_of_time(samples, period_s / std::sqrt(12.0));
  const double settled_s = course_.hops.front().from_s + imu_settling_s(period_s);
  for (std::size_t i = 0; i < samples.value.size(); i += every) {
    const double t = samples.time_s[i];
    if (t < course_.hops.front().from_s || t > course_.end_s) continue;
    if (is_accelerometer(c) && course_.hops.front().at_rest && t <= settled_s) continue;
    const std::uint32_t block = block_at(t);
    auto& span = spans_[c][block];
    if (span.count++ == 0) span.first = rows.size();
    times_.push_back(t);
    ages_s_.push_back(ages[i]);
    rows.push_back({static_cast<std::uint32_t>(c), block, kFlight, t, samples.value[i], unsure[i]});
    rows.back().at_limit =
        is_command(c) && std::abs(samples.value[i]) >= kAtLimit * world_.motor.torque_limit_Nm;
  }
}

std::uint32_t HopperTrial::block_at(double t) const {
  std::uint32_t block = 0;
  while (block + 1 < blocks && t >= course_.hops[block + 1].from_s) ++block;
  return block;
}

Phase HopperTrial::window_at(double t) const {
  Phase phase = kFlight;
  for (std::size_t i = 0; i < course_.phases.size(); ++i) {
    const double change = course_.phases[i].time_s;
    if (i > 0) {
      const auto now = course_.phases[i].phase;
      if (now == HopperPhase::compression && t > change - 0.015 && t < change + 0.015) return kTouchdown;
      if (now == HopperPhase::extension && t > change - 0.010 && t < change + 0.015) return kSwitch;
      if (now == HopperPhase::flight && t > change - 0.010 && t < change + 0.015) return kLiftoff;
    }
    if (change <= t)
      phase = course_.phases[i].phase == HopperPhase::flight        ? kFlight
              : course_.phases[i].phase == HopperPhase::compression ? kCompression
                                                                    : kExtension;
  }
  return phase;
}

void HopperTrial::end_before_end_stop(const Trial& trial) {
  const auto angle = mean_of_motors(trial, "position_rad");
  for (std::size_t i = 0; i < angle.value.size(); ++i)
    if (angle.time_s[i] > course_.hops.front().from_s &&
        (angle.value[i] < Plant::kEndStopLow_rad + kNearEndStop_rad ||
         angle.value[i] > Plant::kEndStopHigh_rad - kNearEndStop_rad)) {
      course_.end_s = std::min(course_.end_s, angle.time_s[i]);
      return;
    }
}

void HopperTrial::end_before_next_landing() {
  if (course_.phases.empty() || course_.phases.back().phase != HopperPhase::flight ||
      course_.phases.size() < 2 || course_.phases.back().time_s >= course_.end_s)
    return;
  const std::vector<double> zero(nuisance_count(), 0.0);
  const auto run = simulate_hopper(run_of(world_, blocks - 1, zero), {});
  const double liftoff_s = course_.phases.back().time_s;
  for (std::size_t i = 0; i < run.force_N.values.size(); ++i) {
    const double t = run.force_N.start_s + run.force_N.step_s * static_cast<double>(i);
    if (t < liftoff_s + kAloft_s || run.force_N.values[i] <= 0.0) continue;
    course_.end_s = std::min(course_.end_s, 0.5 * (liftoff_s + t));
    return;
  }
}

void HopperTrial::label_rows() {
  Coordinate z{"foot_z_m", {}}, v{"foot_velocity_mps", {}}, a{"foot_accel_mps2", {}},
      phi{"motor_position_rad", {}}, time{"t_s", {}};
  const std::vector<double> zero(nuisance_count(), 0.0);
  std::vector<HopperTraces> runs;
  for (std::uint32_t b = 0; b < blocks; ++b) runs.push_back(simulate_hopper(run_of(world_, b, zero), {}));
  for (Row& row : rows) {
    const auto& run = runs[row.block];
    z.values.push_back(run.foot_z_m.at(row.time_s));
    v.values.push_back(run.foot_velocity_mps.at(row.time_s));
    a.values.push_back(run.foot_accel_mps2.at(row.time_s));
    phi.values.push_back(run.angle_rad.at(row.time_s));
    time.values.push_back(row.time_s);
    row.phase = window_at(row.time_s);
    // Only in flight does the controller damp the measured speed, with its noise. The noise of the commands
    // therefore changes exactly at touchdown and liftoff, not some milliseconds around them.
    if (is_command(row.channel)) {
      const bool aloft = phase_at(course_.phases, row.time_s) == HopperPhase::flight;
      if (row.phase == kTouchdown && aloft) row.phase = kFlight;
      if (row.phase == kLiftoff && !aloft) row.phase = kExtension;
    }
  }
  coordinates = {std::move(z), std::move(v), std::move(a), std::move(phi), std::move(time)};
}

}  // namespace sandhopper::diagnose::hopper

namespace sandhopper::diagnose {

std::vector<std::string> hopper_channels() {
  std::vector<std::string> names;
  for (const auto& source : hopper::kSources) names.emplace_back(source.channel);
  return names;
}

std::vector<std::string> hopper_phases() {
  return {"flight", "touchdown", "compression", "switch", "extension", "liftoff"};
}

std::unique_ptr<TrialModel> hopper_trial(const Trial& trial, const Belief& belief) {
  auto model = std::make_unique<hopper::HopperTrial>(trial, belief);
  if (!model->has_late_commands()) return model;
  return std::make_unique<hopper::HopperTrial>(with_commands_a_row_earlier(trial), belief);
}

}  // namespace sandhopper::diagnose
