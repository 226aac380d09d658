#include "firmware/arming.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sandhopper {

Arming::Arming(const CycleConfig& config, const Leg& leg) noexcept
    : config_(config),
      expected_angle_rad_(leg.angle_at_length(config.arming.zero_pose_length_m)),
      drives_(config) {}

void Arming::begin(std::int64_t now_ns) noexcept {
  drives_.begin(now_ns);
  confirmed_ = false;
  angle_rad_ = {};
  body_accel_ = foot_accel_ = load_cell_ = tof_ = {};
  lowest_rad_.fill(std::numeric_limits<double>::infinity());
  highest_rad_.fill(-std::numeric_limits<double>::infinity());
}

std::optional<Arming::Verdict> Arming::update(const SensorFrame& frame) noexcept {
  if (!confirmed_) {
    const auto result = drives_.update(frame);
    if (result == DriveConfirmation::Result::refused) return not_confirmed();
    if (result == DriveConfirmation::Result::pending) return std::nullopt;
    confirmed_ = true;
    window_begin_ns_ = frame.time_ns;
    return std::nullopt;
  }
  for (std::size_t i = 0; i < kMotorCount; ++i) {
    if (!frame.motor[i].fresh) continue;
    angle_rad_[i].add(frame.motor[i].position_rad);
    lowest_rad_[i] = std::min(lowest_rad_[i], frame.motor[i].position_rad);
    highest_rad_[i] = std::max(highest_rad_[i], frame.motor[i].position_rad);
  }
  if (frame.imu_body.fresh) body_accel_.add(frame.imu_body.accel_mps2[2]);
  if (frame.imu_foot.fresh) foot_accel_.add(frame.imu_foot.accel_mps2[2]);
  if (frame.load_cell.fresh) load_cell_.add(frame.load_cell.force_N);
  if (frame.tof.fresh && std::isfinite(frame.tof.height_m)) tof_.add(frame.tof.height_m);
  if (to_s(frame.time_ns - window_begin_ns_) < config_.arming.window_s) return std::nullopt;
  return judge();
}

void Arming::write(Command& command) const noexcept {
  command.drive = confirmed_ ? DriveRequest::enable : drives_.drive();
  for (std::size_t i = 0; i < static_cast<std::size_t>(config_.robot.motor_count); ++i)
    command.motor[i].torque_Nm = confirmed_ ? 0.0 : drives_.torque_Nm(i);
}

Arming::Verdict Arming::not_confirmed() const noexcept {
  const auto& measured = drives_.measured_Nm();
  return {.passed = false,
          .reason = Reason::drives_not_confirmed,
          .values = {measured[0], measured[1], config_.arming.confirm_torque_Nm,
                     static_cast<double>(drives_.tries())},
          .calibration = {}};
}

Arming::Verdict Arming::judge() const noexcept {
  const double left = angle_rad_[0].value();
  const bool two = config_.robot.motor_count == 2;
  const double right = two ? angle_rad_[1].value() : left;
  const double range =
      std::max(highest_rad_[0] - lowest_rad_[0], two ? highest_rad_[1] - lowest_rad_[1] : 0.0);
  Verdict v{.passed = false,
            .reason = Reason::zero_confirmed,
            .values = {left, right, expected_angle_rad_, range},
            .calibration = {.body_bias_mps2 = body_accel_.value() - kGravity_mps2,
                            .foot_bias_mps2 = foot_accel_.value() - kGravity_mps2,
                            .load_cell_tare_N = load_cell_.value(),
                            .body_height_m = tof_.value()}};
  const bool motors = angle_rad_[0].count > 0 && (!two || angle_rad_[1].count > 0);
  if (!motors || !body_accel_.count || !foot_accel_.count || !load_cell_.count || !tof_.count)
    v.reason = Reason::sensor_missing;
  else if (range > config_.arming.still_range_rad)
    v.reason = Reason::moving;
  else if (std::abs(left - right) > config_.limits.encoder_mismatch_rad)
    v.reason = Reason::encoders_disagree;
  else if (std::max(std::abs(left - expected_angle_rad_), std::abs(right - expected_angle_rad_)) >
           config_.arming.zero_tolerance_rad)
    v.reason = Reason::not_at_zero_pose;
  else
    v.passed = true;
  return v;
}

}  // namespace sandhopper
