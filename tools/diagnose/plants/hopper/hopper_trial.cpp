#include "tools/diagnose/plants/hopper/hopper_trial.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

#include "tools/diagnose/plants/hopper/hopper_belief.hpp"
#include "tools/diagnose/plants/hopper/hopper_recording.hpp"
#include "tools/diagnose/plants/hopper/hopper_runs.hpp"
#include "tools/diagnose/plants/hopper/recorded_controller.hpp"
#include "tools/diagnose/plants/intruder/bed_grains.hpp"

namespace sandhopper::diagnose {
namespace {

constexpr std::size_t kMostKnots = 16;  // of the bed's fluctuation along depth
constexpr std::size_t kRunsKept = 6;    // of each hop
constexpr double kDeepest_m = 0.048;    // that the knots cover
constexpr double kMargin = 1.5;         // of the depth that the belief says the foot reaches
constexpr double kSurfaceUnknown_m = 3e-4;
constexpr double kReleaseUnknown_m = 2e-4;
constexpr double kReleaseSpeedUnknown_mps = 1e-3;
constexpr double kReleaseAngleUnknown_rad = 2e-4;
constexpr double kNearEndStop_rad = 0.04;
constexpr double kAloft_s = 0.02;  // a liftoff is over by then
// Of derivatives: what events jump by is small against what such a step brings, and is not at a quarter of
// it.
constexpr double kWideStep = 4.0;
constexpr double kAtRest = 0.01;  // share of a later hop's uncertainty that a release at rest has

enum Phase : std::uint32_t { kFlight, kTouchdown, kCompression, kSwitch, kExtension, kLiftoff };

enum TrialNuisance : std::size_t {
  kStiffness,
  kReleaseHeight,
  kReleaseSpeed,
  kReleaseAngle,
  kSurface,
  kCable,
  kTorqueConstant,
  kTofBias,
  kBodyBias,
  kFootBias,
  kBodyScale,
  kFootScale,
  kLeftOffset,
  kRightOffset,
  kCellOffset,
  kTofAge,
  kCellAge,
  kMocapAge,
  kFirstKnot
};
enum HopNuisance : std::size_t { kFootZ, kFootV, kAngle, kRate, kCrater, kHopNuisances };

// How a recorded channel comes from a run: which trace, with which share, through which sensor.
struct ChannelSource {
  const char* channel;
  Signal HopperTraces::*trace;
  const char* sensor;  // of the belief's keys
  const char* unit;
  std::size_t every;  // sample that is kept: fast channels say the same thing many times
  std::optional<TrialNuisance> offset{}, scale{}, age{};
};
constexpr std::array<ChannelSource, 14> kSources{
    {{"motor_left_position_rad", &HopperTraces::angle_rad, "", "", 4},
     {"motor_right_position_rad", &HopperTraces::angle_rad, "", "", 4},
     {"motor_left_velocity_radps", &HopperTraces::rate_radps, "encoder_velocity", "radps", 4},
     {"motor_right_velocity_radps", &HopperTraces::rate_radps, "encoder_velocity", "radps", 4},
     {"motor_left_current_A", &HopperTraces::current_torque_Nm, "", "", 2, kLeftOffset},
     {"motor_right_current_A", &HopperTraces::current_torque_Nm, "", "", 2, kRightOffset},
     {"command_left_torque_Nm", &HopperTraces::command_torque_Nm, "", "", 4},
     {"command_right_torque_Nm", &HopperTraces::command_torque_Nm, "", "", 4},
     {"imu_body_accel_z_mps2", &HopperTraces::body_accel_mps2, "imu", "mps2", 2, kBodyBias, kBodyScale},
     {"imu_foot_accel_z_mps2", &HopperTraces::foot_accel_mps2, "imu", "mps2", 2, kFootBias, kFootScale},
     {"tof_height_m", &HopperTraces::body_z_m, "tof", "m", 1, kTofBias, {}, kTofAge},
     {"load_cell_force_N", &HopperTraces::force_N, "load_cell", "N", 1, kCellOffset, {}, kCellAge},
     {"mocap_body_z_m", &HopperTraces::body_z_m, "mocap", "m", 1, {}, {}, kMocapAge},
     {"mocap_foot_z_m", &HopperTraces::foot_z_m, "mocap", "m", 1, {}, {}, kMocapAge}}};
enum Source : std::size_t {
  kLeftCurrent = 4,
  kRightCurrent,
  kLeftCommand,
  kRightCommand,
  kImuBody,
  kImuFoot,
  kTof,
  kLoadCell
};
constexpr bool is_command(std::size_t source) { return source == kLeftCommand || source == kRightCommand; }

class HopperTrial final : public TrialModel {
 public:
  HopperTrial(const Trial& trial, const Belief& belief)
      : belief_(with_payload(belief, trial)), world_(world_of(belief_, {})) {
    name = trial.name;
    const Leg leg(world_.robot.leg);
    bed_history_ = {trial.setup_or("pushes_since_preparation", 0.0), trial.setup_or("wait_s", 0.0),
                    trial.setup_or("bed_depth_m", 0.0)};
    compression_stiffness_ = trial.setup_or("compression_stiffness_N_per_m", 375.0);
    course_ = course_of(trial, leg, world_.controller.compression_length_m);
    if (course_.hops.empty()) return;
    end_before_end_stop(trial);
    const auto temperature = mean_of_motors(trial, "temperature_C");
    for (const double t : temperature.value)
      motor_temperature_C_ += (t - kRoom_C) / static_cast<double>(temperature.value.size());
    if (world_.terrain.rigid || course_.phases.empty()) {
      take_commands(trial);
    } else {
      controller_ = RecordedController(trial, leg, world_, course_.end_s);
      controller_.find_age(world_, compression_stiffness_, course_.phases);
      residual_ = controller_.residual_Nm(world_, compression_stiffness_, course_.phases);
    }
    blocks = static_cast<std::uint32_t>(course_.hops.size());
    runs_ = HopperRuns(kRunsKept * blocks);
    add_nuisances();
    end_before_next_landing();
    for (std::size_t c = 0; c < kSources.size(); ++c) add_rows(trial, c);
    if (!rows.empty()) label_rows();
  }

  void predict(const Edits& edits, std::span<const double> n, std::span<double> out) const override {
    const WorldConfig world = world_of(belief_, edits);
    std::vector<double> plant_nuisances;
    for (std::size_t i = 0; i < n.size(); ++i)
      if (i < kTofBias || i >= kFirstKnot) plant_nuisances.push_back(n[i]);
    const auto key = HopperRuns::key(edits, plant_nuisances);
    for (std::uint32_t b = 0; b < blocks; ++b) {
      auto& run = runs_.run(key, b, [&] { return simulated(world, edits, b, n); });
      for (std::size_t c = 0; c < kSources.size(); ++c) {
        const auto& span = spans_[c][b];
        if (span.count == 0) continue;
        const std::array own{offset_of(c, n), scale_of(c, n), age_share(c, n)};
        run.read(c, HopperRuns::reading_key(edits, kSources[c].channel, own),
                 out.subspan(span.first, span.count),
                 [&](std::span<double> at) { read_channel(world, run.traces, edits, n, c, span, at); });
      }
    }
  }

  std::vector<VariantPair> variants() const override {
    constexpr double kFiner = 0.5, kHalfARow = 0.5;
    std::vector<VariantPair> pairs{{{}, {Variant::Kind::step, 0, kFiner}}};
    for (std::size_t i = 1; i < course_.phases.size(); ++i)
      if (course_.phases[i].time_s < course_.end_s)
        pairs.push_back({{Variant::Kind::event, i, -kHalfARow}, {Variant::Kind::event, i, kHalfARow}});
    return pairs;
  }

  void predict_variant(const Variant& variant, const Edits& edits, std::span<const double> n,
                       std::span<double> out) const override {
    const WorldConfig world = world_of(belief_, edits);
    auto phases = course_.phases;
    if (variant.kind == Variant::Kind::event) phases[variant.event].time_s += variant.amount * kTick_s;
    for (std::uint32_t b = 0; b < blocks; ++b) {
      HopperRun run = run_of(world, b, n);
      if (variant.kind == Variant::Kind::step) run.step_s *= variant.amount;
      if (run.phases != nullptr) run.phases = &phases;
      run.switch_between_cycles = variant.kind == Variant::Kind::event;
      const auto traces = simulate_hopper(run, edits);
      for (std::size_t c = 0; c < kSources.size(); ++c)
        if (const auto& span = spans_[c][b]; span.count > 0)
          read_channel(world, traces, edits, n, c, span, out.subspan(span.first, span.count));
    }
  }

 private:
  struct Span {
    std::size_t first = 0, count = 0;
  };

  void take_commands(const Trial& trial) {
    const auto commands = commands_of(trial);
    if (commands.empty()) return;
    commands_ = on_grid(commands, 0.0, kTick_s, static_cast<std::size_t>(course_.end_s / kTick_s) + 2, true);
  }

  void add_nuisances() {
    const auto& s = world_.spread;
    // `least`: what nobody knows it better than.
    const auto add = [&](const std::string& what, double believed_sd, double least, double step,
                         const char* port = "") {
      trial_nuisances.push_back(
          {what, std::max(believed_sd, least), kWideStep * step, port, believed_sd > least});
    };
    add("bed_stiffness_relative", s.bed_stiffness_relative, 1e-3, 1e-3, "ground");
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

  // The run with another controller than is believed: what was commanded is held against that one.
  HopperTraces simulated(const WorldConfig& world, const Edits& edits, std::uint32_t block,
                         std::span<const double> n) const {
    HopperRun run = run_of(world, block, n);
    const bool other = std::ranges::any_of(
        edits.belief, [](const BeliefEdit& edit) { return edit.key.starts_with("controller."); });
    if (!other || run.command_residual_Nm == nullptr) return simulate_hopper(run, edits);
    run.compression_stiffness_N_per_m = compression_stiffness_of(edits);
    const Signal residual = controller_.residual_Nm(world, run.compression_stiffness_N_per_m, course_.phases);
    run.command_residual_Nm = &residual;
    return simulate_hopper(run, edits);
  }

  double compression_stiffness_of(const Edits& edits) const {
    return edits.edited("controller.compression_stiffness_N_per_m", compression_stiffness_);
  }

  double deepest_believed_m() const {
    double lowest_m = 0.0;
    for (std::uint32_t b = 0; b < blocks; ++b)
      for (const double z :
           simulate_hopper(run_of(world_, b, std::vector<double>(kFirstKnot + blocks * kHopNuisances, 0.0)),
                           {})
               .foot_z_m.values)
        lowest_m = std::min(lowest_m, z);
    return -lowest_m;
  }

  HopperRun run_of(const WorldConfig& world, std::uint32_t block, std::span<const double> n) const {
    HopperRun run;
    run.world = world;
    run.world.terrain.stiffness_N_per_m *= 1.0 + n[kStiffness];
    run.world.terrain.stiffness_per_area_N_per_m3 *= 1.0 + n[kStiffness];
    run.compression_stiffness_N_per_m = compression_stiffness_;
    run.surface_m = n[kSurface];
    run.cable_force_N = n[kCable];
    run.torque_constant_factor = 1.0 + n[kTorqueConstant];
    run.motor_temperature_C = motor_temperature_C_;
    if (grains_.count() > 0) run.fluctuation = grains_.fluctuation(n.subspan(kFirstKnot));
    const HopStart& hop = course_.hops[block];
    run.start = hop.state;
    run.crater_m = hop.crater_m;
    run.bed_history = bed_history_;
    run.from_s = hop.from_s;
    run.to_s = block + 1 < blocks ? course_.hops[block + 1].from_s : course_.end_s;
    if (hop.at_rest) {
      run.start.foot_z_m += n[kReleaseHeight];
      run.start.foot_velocity_mps += n[kReleaseSpeed];
      run.start.angle_rad += n[kReleaseAngle];
    }
    if (!block_nuisances.empty()) {
      const auto own = n.subspan(trial_nuisances.size() + block * kHopNuisances, kHopNuisances);
      const double share = hop.at_rest ? kAtRest : 1.0;
      run.start.foot_z_m += share * own[kFootZ];
      run.start.foot_velocity_mps += share * own[kFootV];
      run.start.angle_rad += share * own[kAngle];
      run.start.angular_velocity_radps += share * own[kRate];
      run.crater_m = std::max(0.0, run.crater_m + (block == 0 ? 0.0 : own[kCrater]));
    }
    run.phases = &course_.phases;
    if (!commands_.values.empty()) run.recorded_command_Nm = &commands_;
    if (!residual_.values.empty()) run.command_residual_Nm = &residual_;
    return run;
  }

  static double offset_of(std::size_t c, std::span<const double> n) {
    return kSources[c].offset ? n[*kSources[c].offset] : 0.0;
  }
  static double scale_of(std::size_t c, std::span<const double> n) {
    return kSources[c].scale ? 1.0 + n[*kSources[c].scale] : 1.0;
  }

  static double age_share(std::size_t c, std::span<const double> n) {
    return kSources[c].age ? kAgeShare + n[*kSources[c].age] : 1.0;
  }

  void read_channel(const WorldConfig& world, const HopperTraces& traces, const Edits& edits,
                    std::span<const double> n, std::size_t c, const Span& span, std::span<double> at) const {
    if (is_command(c) && controller_.measured()) {
      read_command(world, edits, span, at);
      return;
    }
    Signal signal = traces.*kSources[c].trace;
    const double motors = world.robot.leg.motor_count;
    switch (c) {
      case kLeftCurrent:
      case kRightCurrent:
        for (double& v : signal.values) v /= motors * world.motor.torque_constant_Nm_per_A;
        break;
      case kLeftCommand:
      case kRightCommand:
        for (double& v : signal.values) v /= motors;
        break;
      case kImuBody:
      case kImuFoot:
        for (double& v : signal.values) v = scale_of(c, n) * (v + world.gravity_mps2);
        break;
      case kLoadCell: {
        const auto laws = edits.at("load_cell");
        if (!laws.empty())
          for (std::size_t i = 0; i < signal.values.size(); ++i)
            signal.values[i] += sum_of(laws, {.accel = traces.foot_accel_mps2.values[i]});
        break;
      }
      default:
        break;
    }
    const auto sampled_s = sampled(span, age_share(c, n));
    observe(signal, sensors_[c], edits, kSources[c].channel, sampled_s, at);
    const double offset = offset_of(c, n);
    for (double& v : at) v += offset;
  }

  // What was commanded follows from what was measured, not from the run; mostly by the controller as
  // believed.
  void read_command(const WorldConfig& world, const Edits& edits, const Span& span,
                    std::span<double> at) const {
    const auto commanded = [&](std::span<double> out) {
      controller_.commands_Nm(world, compression_stiffness_of(edits), course_.phases,
                              std::span(times_).subspan(span.first, span.count), out);
    };
    if (!edits.belief.empty()) return commanded(at);
    auto& believed = believed_commands_[span.first];
    if (believed.empty()) commanded(believed = std::vector<double>(span.count));
    std::ranges::copy(believed, at.begin());
  }

  // Whether a row's value is of the instant at which a slow sensor sampled or of the row's is not told.
  std::vector<double> sampled(const Span& span, double age_share) const {
    std::vector<double> at_s(span.count);
    for (std::size_t i = 0; i < span.count; ++i)
      at_s[i] = times_[span.first + i] - age_share * ages_s_[span.first + i];
    return at_s;
  }

  // Of the sensors with a clock of their own.
  double rate_Hz(std::size_t c) const {
    const auto& sensors = world_.sensors;
    return c == kTof        ? sensors.tof_rate_Hz
           : c == kLoadCell ? sensors.load_cell_rate_Hz
           : c > kLoadCell  ? sensors.mocap_rate_Hz
                            : 0.0;
  }

  // A sensor that samples more often than rows are written, with a clock of its own, leaves no empty cells
  // that would tell when: a row holds the latest sample, half a period old in the middle.
  double period_within_rows_s(std::size_t c, double step_s) const {
    if (c != kImuBody && c != kImuFoot) return 0.0;
    const double rate_Hz = belief_.value("sensors.imu_rate_Hz");
    return rate_Hz * step_s > 1.01 ? 1.0 / rate_Hz : 0.0;
  }

  // Standard deviation against that of a sample whose time is known.
  static std::vector<double> unsure_of_time(const Samples& samples, double age_sd_s) {
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

  void add_rows(const Trial& trial, std::size_t c) {
    sensors_[c] = sensor_belief(belief_, kSources[c].sensor, kSources[c].unit);
    spans_[c].assign(blocks, {});
    // The believed controller is that of a hop: what holds a leg still is not written down.
    // Nor is a command held against a speed that was not recorded: exact to its digits, it would show every
    // hundredth of a radian per second by which a simulation is off.
    if (is_command(c) && (trial.kind == "hold" || !controller_.measured())) return;
    const auto samples = samples_of(trial, kSources[c].channel);
    if (samples.value.size() < 10) return;
    auto ages = ages_s(trial, kSources[c].channel, rate_Hz(c));
    const double step_s = median_step_s(samples.time_s);
    const double period_s = period_within_rows_s(c, step_s);
    if (ages.size() != samples.value.size()) ages.assign(samples.value.size(), 0.5 * period_s);
    const std::size_t every = step_s < 1.5e-3 ? kSources[c].every : 1;
    const auto unsure = unsure_of_time(samples, period_s / std::sqrt(12.0));
    for (std::size_t i = 0; i < samples.value.size(); i += every) {
      const double t = samples.time_s[i];
      if (t < course_.hops.front().from_s || t > course_.end_s) continue;
      const std::uint32_t block = block_at(t);
      auto& span = spans_[c][block];
      if (span.count++ == 0) span.first = rows.size();
      times_.push_back(t);
      ages_s_.push_back(ages[i]);
      rows.push_back({static_cast<std::uint32_t>(c), block, kFlight, t, samples.value[i], unsure[i]});
    }
  }

  std::uint32_t block_at(double t) const {
    std::uint32_t block = 0;
    while (block + 1 < blocks && t >= course_.hops[block + 1].from_s) ++block;
    return block;
  }

  Phase window_at(double t) const {
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

  // A leg that is thrown against its end stop bounces: when, depends on hundredths of a millisecond.
  void end_before_end_stop(const Trial& trial) {
    const auto angle = mean_of_motors(trial, "position_rad");
    for (std::size_t i = 0; i < angle.value.size(); ++i)
      if (angle.time_s[i] > course_.hops.front().from_s &&
          (angle.value[i] < Plant::kEndStopLow_rad + kNearEndStop_rad ||
           angle.value[i] > Plant::kEndStopHigh_rad - kNearEndStop_rad)) {
        course_.end_s = std::min(course_.end_s, angle.time_s[i]);
        return;
      }
  }

  // A controller that never sees the next landing records no end of its flight: the simulation knows it.
  void end_before_next_landing() {
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

  void label_rows() {
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
      // Aloft the controller damps what it measures of the speed, noise and all, on the ground it does not:
      // the commands change at the instants themselves, not around them.
      if (is_command(row.channel)) {
        const bool aloft = phase_at(course_.phases, row.time_s) == HopperPhase::flight;
        if (row.phase == kTouchdown && aloft) row.phase = kFlight;
        if (row.phase == kLiftoff && !aloft) row.phase = kExtension;
      }
    }
    coordinates = {std::move(z), std::move(v), std::move(a), std::move(phi), std::move(time)};
  }

  mutable HopperRuns runs_;
  mutable std::map<std::size_t, std::vector<double>> believed_commands_;  // by a span's first row
  Belief belief_;
  WorldConfig world_;
  double compression_stiffness_ = 375.0;
  double motor_temperature_C_ = kRoom_C;
  BedHistory bed_history_;
  HopperCourse course_;
  Signal commands_{0.0, kTick_s, {}}, residual_{0.0, kTick_s, {}};
  RecordedController controller_;
  BedGrains grains_;
  std::array<std::vector<Span>, kSources.size()> spans_;
  std::array<SensorBelief, kSources.size()> sensors_{};
  std::vector<double> times_, ages_s_;
};

}  // namespace

std::vector<std::string> hopper_channels() {
  std::vector<std::string> names;
  for (const auto& source : kSources) names.emplace_back(source.channel);
  return names;
}

std::vector<std::string> hopper_phases() {
  return {"flight", "touchdown", "compression", "switch", "extension", "liftoff"};
}

std::unique_ptr<TrialModel> hopper_trial(const Trial& trial, const Belief& belief) {
  return std::make_unique<HopperTrial>(trial, belief);
}

}  // namespace sandhopper::diagnose
