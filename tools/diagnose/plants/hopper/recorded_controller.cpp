#include "tools/diagnose/plants/hopper/recorded_controller.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sandhopper::diagnose {
namespace {

constexpr std::size_t kSmoothingSamples = 6;  // samples to each side
constexpr double kLengthUnsure_m = 5e-4;      // uncertainty of the measured length of the leg
constexpr double kMostLate_s = 0.02;          // greatest delay that is reported

// Zero crossing between two instants, as a share of the interval, for a quantity that is negative at the
// first one only; else 0.
double crossing(double before, double after) { return before < 0.0 ? before / (before - after) : 0.0; }

// Smooths, and adds the smoothed residual. One pass by parabolas flattens a strong curvature, e.g. of a leg
// at liftoff.
Smoothed smoothed_twice(const Samples& samples) {
  Smoothed once = smooth(samples, kSmoothingSamples);
  Samples left = samples;
  for (std::size_t i = 0; i < left.value.size(); ++i) left.value[i] -= once.value[i];
  const Smoothed again = smooth(left, kSmoothingSamples);
  for (std::size_t i = 0; i < once.value.size(); ++i) {
    once.value[i] += again.value[i];
    once.rate[i] += again.rate[i];
  }
  return once;
}

}  // namespace

RecordedController::RecordedController(const Trial& trial, const Leg& leg, const WorldConfig& believed,
                                       double end_s)
    : leg_(leg),
      measured_(measured_leg(trial)),
      commands_(commands_of(trial)),
      end_s_(end_s),
      rate_time_constant_s_(1.0 / (2.0 * std::numbers::pi * believed.sensors.encoder_velocity_bandwidth_Hz)) {
  take_smoothed(nullptr, nullptr);
}

void RecordedController::smooth_about(const Signal& angle_rad, const Signal& rate_radps) {
  take_smoothed(&angle_rad, &rate_radps);
}

void RecordedController::take_smoothed(const Signal* angle_rad, const Signal* rate_radps) {
  if (!measured()) return;
  Samples apart{measured_.time_s, measured_.angle_rad};
  if (angle_rad != nullptr)
    for (std::size_t i = 0; i < apart.value.size(); ++i)
      apart.value[i] -= angle_rad->at(apart.time_s[i] - age_s_);
  const Smoothed smoothed = smoothed_twice(apart);
  const auto count = static_cast<std::size_t>(end_s_ / kTick_s) + 2;
  const auto together = [&](const std::vector<double>& of_difference, const Signal* simulated) {
    Signal sum = on_grid({measured_.time_s, of_difference}, 0.0, kTick_s, count, false);
    if (simulated != nullptr)
      for (std::size_t i = 0; i < count; ++i)
        sum.values[i] += simulated->at(kTick_s * static_cast<double>(i) - age_s_);
    return sum;
  };
  smooth_angle_ = together(smoothed.value, angle_rad);
  smooth_rate_ = together(smoothed.rate, rate_radps);
  smooth_rate_.low_pass(rate_time_constant_s_);
}

void RecordedController::find_age(const WorldConfig& world, double compression_stiffness_N_per_m,
                                  const std::vector<PhaseChange>& phases) {
  constexpr int kOldest = 2;       // rows
  constexpr double kNearer = 0.5;  // largest ratio of the differences for a larger age
  if (!measured() || commands_.empty()) return;
  const double row_s = median_step_s(measured_.time_s);
  const auto as_read = measured_.time_s;
  std::vector<double> commands(commands_.time_s.size());
  double nearest = 0.0;
  int age = 0;
  for (int rows = 0; rows <= kOldest; ++rows) {
    for (std::size_t i = 0; i < as_read.size(); ++i) measured_.time_s[i] = as_read[i] + rows * row_s;
    commands_Nm(world, compression_stiffness_N_per_m, phases, commands_.time_s, commands);
    double apart = 0.0;
    for (std::size_t i = kOldest; i < commands.size(); ++i)
      apart += std::abs(commands_.value[i] - world.robot.leg.motor_count * commands[i]);
    if (rows == 0 || apart < kNearer * nearest) nearest = apart, age = rows;
  }
  age_s_ = age * row_s;
  for (std::size_t i = 0; i < as_read.size(); ++i) measured_.time_s[i] = as_read[i] + age_s_;
}

Signal RecordedController::residual_Nm(const WorldConfig& world, double compression_stiffness_N_per_m,
                                       const std::vector<PhaseChange>& phases) const {
  if (!measured() || commands_.empty()) return {0.0, kTick_s, {}};
  // Between two samples the difference is interpolated, not the command, which jumps with the phase.
  Samples residual = commands_;
  for (std::size_t i = 0; i < residual.value.size(); ++i) {
    const double t = residual.time_s[i];
    residual.value[i] -=
        spring_torque_Nm(world, compression_stiffness_N_per_m,
                         {phase_at(phases, t), leg_.kinematics(smooth_angle_.at(t)), smooth_rate_.at(t)});
  }
  return on_grid(residual, 0.0, kTick_s, smooth_angle_.values.size(), false);
}

void RecordedController::commands_Nm(const WorldConfig& world, double compression_stiffness_N_per_m,
                                     const std::vector<PhaseChange>& phases, std::span<const double> times_s,
                                     std::span<double> out) const {
  std::size_t k = 0;
  for (std::size_t i = 0; i < times_s.size(); ++i) {
    while (k + 1 < measured_.time_s.size() && measured_.time_s[k + 1] <= times_s[i] + 1e-7) ++k;
    const SpringState at{phase_at(phases, times_s[i]), leg_.kinematics(measured_.angle_rad[k]),
                         measured_.rate_radps[k]};
    out[i] = spring_torque_Nm(world, compression_stiffness_N_per_m, at) / world.robot.leg.motor_count;
  }
}

std::optional<double> RecordedController::due_s(const WorldConfig& world, const Between& times,
                                                double shorter_m) const {
  const auto& c = world.controller;
  double time_before_s = 0.0, rate_before = 0.0, beyond_before_m = 0.0;
  std::optional<double> due;
  for (std::size_t i = 0; i < measured_.time_s.size(); ++i) {
    const double t = measured_.time_s[i];
    if (t < times.from_s) continue;
    if (t > times.to_s || (t >= times.switch_s && due)) break;
    const auto kinematics = leg_.kinematics(measured_.angle_rad[i]);
    const double rate = kinematics.dlength_m_per_rad * measured_.rate_radps[i];
    const double beyond_m = c.compression_length_m - kinematics.length_m - shorter_m;
    const bool holds = rate >= 0.0 && beyond_m > 0.0;
    if (!holds && due && t - *due > kCyclesToSwitch / c.rate_Hz) break;
    if (!holds)
      due.reset();
    else if (!due)
      due = time_before_s == 0.0
                ? t
                : time_before_s + std::max(crossing(rate_before, rate), crossing(beyond_before_m, beyond_m)) *
                                      (t - time_before_s);
    time_before_s = t;
    rate_before = rate;
    beyond_before_m = beyond_m;
  }
  return due;
}

std::vector<double> RecordedController::late_switches_s(const WorldConfig& world,
                                                        const std::vector<PhaseChange>& phases) const {
  std::vector<double> late_s;
  if (!measured()) return late_s;
  const double step_s = median_step_s(measured_.time_s);
  for (std::size_t i = 1; i < phases.size(); ++i) {
    if (phases[i].phase != HopperPhase::compression) continue;
    // Rows are missing where the switch was made.
    if (i + 1 < phases.size() && phases[i + 1].unsure_s > 0.0) continue;
    const bool last = i + 1 == phases.size();
    const double to_s = last ? end_s_ : phases[i + 1].time_s;
    // If the change came early, its due time is after it.
    const bool made = !last && phases[i + 1].phase == HopperPhase::extension;
    const double until_s = made ? end_s_ : to_s, least_m = world.controller.compression_end_min_deflection_m;
    const double switch_s = to_s - 0.5 * step_s;
    const Between times{phases[i].time_s, until_s, made ? switch_s : phases[i].time_s};
    const auto first = due_s(world, times, least_m - kLengthUnsure_m);
    const auto surely = due_s(world, times, least_m + kLengthUnsure_m);
    if (!first || !surely) continue;
    late_s.push_back(std::clamp(switch_s - std::clamp(switch_s, *first, std::max(*first, *surely)),
                                -kMostLate_s, kMostLate_s));
  }
  return late_s;
}

std::vector<double> late_switches_s(const Trial& trial, const WorldConfig& world) {
  if (trial.time_s.empty()) return {};
  const Leg leg(world.robot.leg);
  const double end_s = trial.time_s.back();
  return RecordedController(trial, leg, world, end_s).late_switches_s(world, phase_changes(trial));
}

}  // namespace sandhopper::diagnose
