#include "firmware/supervision/supervisor.hpp"

#include <cmath>

#include "firmware/supervision/end_stop.hpp"

namespace sandhopper {
namespace {

using Limits = SensorCheck::Limits;

Limits imu_limits(const CycleConfig& c) noexcept {
  const auto& s = c.supervision;
  return {c.limits.imu_age_s, s.imu_rate_Hz, s.stuck_samples, static_cast<double>(s.range_samples), 1.0};
}
Limits tof_limits(const CycleConfig& c) noexcept {
  const auto& s = c.supervision;
  return {c.limits.tof_age_s, s.tof_rate_Hz, s.stuck_samples, static_cast<double>(s.range_samples), 1.0};
}
// The noise of a broken wire crosses the range repeatedly. So half as many bad samples suffice, and good ones
// decrease the count only slowly.
Limits load_cell_limits(const CycleConfig& c) noexcept {
  const auto& s = c.supervision;
  return {c.limits.load_cell_age_s, s.load_cell_rate_Hz, s.stuck_samples, 0.5 * s.range_samples, 0.25};
}

bool same(const ImuSample& a, const ImuSample& b) noexcept {
  return a.accel_mps2 == b.accel_mps2 && a.gyro_radps == b.gyro_radps;
}

bool within(const ImuSample& imu, double range) noexcept {
  for (const double a : imu.accel_mps2)
    if (!(std::abs(a) < range)) return false;
  for (const double rate : imu.gyro_radps)
    if (!std::isfinite(rate)) return false;
  return true;
}

}  // namespace

Supervisor::Supervisor(const CycleConfig& config, const Leg& leg) noexcept
    : config_(config),
      cycle_(config.supervision),
      motor_{MotorCheck{config, 0}, MotorCheck{config, 1}},
      motor_pair_(config),
      sensor_{
          SensorCheck{{Fault::imu_stale, Fault::imu_stuck, Fault::imu_out_of_range, 0.0}, imu_limits(config)},
          SensorCheck{{Fault::imu_stale, Fault::imu_stuck, Fault::imu_out_of_range, 1.0}, imu_limits(config)},
          SensorCheck{{Fault::tof_stale, Fault::tof_stuck, Fault::tof_out_of_range, 2.0}, tof_limits(config)},
          SensorCheck{{Fault::load_cell_stale, Fault::load_cell_stuck, Fault::load_cell_out_of_range, 3.0},
                      load_cell_limits(config)}},
      motion_(config, leg) {}

FaultFound Supervisor::check(const SensorFrame& frame, const Estimate& estimate,
                             const Context& context) noexcept {
  Findings findings(off_);
  if (!started_) first_ns_ = frame.time_ns;
  const auto cycles = started_ ? static_cast<std::int64_t>(frame.cycle - last_.cycle) : 1;
  findings.add_if(frame.emergency_stop, Fault::emergency_stop, 1.0, 0.0);
  cycle_.see(frame, findings);
  bus_.see(frame.bus, findings);
  check_motors(frame, context, cycles, findings);
  check_sensors(frame, context, findings);
  const double dt_s = started_ ? static_cast<double>(frame.time_ns - last_.time_ns) * 1e-9 : 0.0;
  motion_.see(frame, estimate, {context.state, dt_s, context.estimating}, findings);
  findings.add_if(context.phase_time_s > config_.limits.phase_time_s, Fault::phase_timeout,
                  context.phase_time_s, config_.limits.phase_time_s);
  findings.add_if(context.touchdowns > static_cast<std::uint32_t>(config_.supervision.hop_count),
                  Fault::hop_count_limit, context.touchdowns, config_.supervision.hop_count);
  last_ = frame;
  started_ = true;
  return findings.worst();
}

void Supervisor::check_motors(const SensorFrame& frame, const Context& context, std::int64_t cycles,
                              Findings& findings) noexcept {
  const double since_start_s = static_cast<double>(frame.time_ns - first_ns_) * 1e-9;
  for (std::size_t i = 0; i < static_cast<std::size_t>(config_.robot.motor_count); ++i)
    motor_[i].see(frame.motor[i],
                  {.time_ns = frame.time_ns,
                   .cycles = cycles,
                   .starting = since_start_s < config_.supervision.startup_s,
                   .energised = context.energised,
                   .drive = context.command.drive,
                   .command = context.command.motor[i]},
                  findings);
  motor_pair_.see(frame.motor, context.energised, findings);
}

void Supervisor::check_sensors(const SensorFrame& frame, const Context& context,
                               Findings& findings) noexcept {
  const auto& s = config_.supervision;
  const double since_start_s = static_cast<double>(frame.time_ns - first_ns_) * 1e-9;
  const auto seen = [&](const auto& sample, bool changed, bool in_range) {
    return SensorCheck::Seen{.now_ns = frame.time_ns,
                             .time_ns = sample.time_ns,
                             .fresh = sample.fresh,
                             .changed = changed,
                             .in_range = in_range,
                             .starting = since_start_s < s.startup_s,
                             .learning = context.state == State::idle || context.state == State::armed};
  };
  sensor_[0].see(
      seen(frame.imu_body, !same(frame.imu_body, last_.imu_body), within(frame.imu_body, s.imu_range_mps2)),
      findings);
  sensor_[1].see(
      seen(frame.imu_foot, !same(frame.imu_foot, last_.imu_foot), within(frame.imu_foot, s.imu_range_mps2)),
      findings);
  const double height = frame.tof.height_m, force = frame.load_cell.force_N;
  const bool blow = std::isfinite(force) && strikes_end_stop(frame.imu_body, config_);
  sensor_[2].see(seen(frame.tof, height != last_.tof.height_m, std::abs(height) < s.tof_range_m), findings);
  sensor_[3].see(
      seen(frame.load_cell, force != last_.load_cell.force_N, blow || std::abs(force) < s.load_cell_range_N),
      findings);
}

}  // namespace sandhopper
