#include "firmware/supervisor.hpp"

#include <cmath>

namespace sandhopper {
namespace {

double age_s(std::int64_t sample_ns, const SensorFrame& frame) noexcept {
  return static_cast<double>(frame.time_ns - sample_ns) * 1e-9;
}

}  // namespace

void Supervisor::begin(const SensorFrame& frame) noexcept {
  misses_ = {};
  bus_faults_ = frame.bus_faults;
}

FaultFound Supervisor::check(const SensorFrame& frame, const Estimate& e, double phase_time_s) noexcept {
  if (frame.emergency_stop) return {Fault::emergency_stop, {1.0, 0.0}};
  if (const auto motors = check_motors(frame); motors.fault != Fault::none) return motors;
  if (const auto ages = check_ages(frame); ages.fault != Fault::none) return ages;
  if (frame.bus_faults != bus_faults_)
    return {Fault::bus_fault, {static_cast<double>(frame.bus_faults), static_cast<double>(bus_faults_)}};
  if (!std::isfinite(e.contact_force_N + e.foot_z_m + e.body_z_m + e.leg_length_m + e.leg_rate_mps))
    return {Fault::estimate_not_finite, {e.contact_force_N, e.foot_z_m}};
  if (phase_time_s > config_.limits.phase_time_s)
    return {Fault::phase_timeout, {phase_time_s, config_.limits.phase_time_s}};
  return {};
}

FaultFound Supervisor::check_motors(const SensorFrame& frame) noexcept {
  const auto& limits = config_.limits;
  const auto motors = static_cast<std::size_t>(config_.robot.motor_count);
  for (std::size_t i = 0; i < motors; ++i) {
    const auto& m = frame.motor[i];
    misses_[i] = m.fresh ? 0 : misses_[i] + 1;
    if (misses_[i] >= limits.motor_reply_misses)
      return {Fault::motor_reply_lost, {static_cast<double>(i), static_cast<double>(misses_[i])}};
    if (m.error_code != 0)
      return {Fault::drive_error, {static_cast<double>(i), static_cast<double>(m.error_code)}};
    if (!(m.position_rad >= limits.leg_angle_min_rad && m.position_rad <= limits.leg_angle_max_rad))
      return {Fault::leg_angle_limit, {static_cast<double>(i), m.position_rad}};
    if (!(std::abs(m.velocity_radps) <= limits.motor_speed_radps))
      return {Fault::motor_speed_limit, {static_cast<double>(i), m.velocity_radps}};
    if (m.temperature_C > limits.motor_temperature_C)
      return {Fault::motor_temperature, {static_cast<double>(i), m.temperature_C}};
  }
  const double mismatch = frame.motor[0].position_rad - frame.motor[1].position_rad;
  if (motors == 2 && std::abs(mismatch) > limits.encoder_mismatch_rad)
    return {Fault::encoders_disagree, {mismatch, limits.encoder_mismatch_rad}};
  return {};
}

FaultFound Supervisor::check_ages(const SensorFrame& frame) const noexcept {
  const auto& limits = config_.limits;
  if (const double age = age_s(frame.imu_body.time_ns, frame); age > limits.imu_age_s)
    return {Fault::imu_stale, {0.0, age}};
  if (const double age = age_s(frame.imu_foot.time_ns, frame); age > limits.imu_age_s)
    return {Fault::imu_stale, {1.0, age}};
  if (const double age = age_s(frame.tof.time_ns, frame); age > limits.tof_age_s)
    return {Fault::tof_stale, {age, limits.tof_age_s}};
  if (const double age = age_s(frame.load_cell.time_ns, frame); age > limits.load_cell_age_s)
    return {Fault::load_cell_stale, {age, limits.load_cell_age_s}};
  return {};
}

}  // namespace sandhopper
