#include "tools/plant/drive.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/plant/plant.hpp"

namespace sandhopper {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;
constexpr double kTemperature_C = 25.0;
constexpr double kBusVoltage_V = 48.0;

}  // namespace

Drive::Drive(const WorldConfig& config, const Imperfection& imperfection, const Noise& noise)
    : motor_(config.motor),
      imperfection_(imperfection),
      lag_decay_(motor_.current_loop_time_constant_s > 0.0
                     ? std::exp(-Plant::kStep_s / motor_.current_loop_time_constant_s)
                     : 0.0),
      velocity_gain_(1.0 - std::exp(-kTwoPi * config.sensors.encoder_velocity_bandwidth_Hz * Plant::kStep_s)),
      count_rad_(imperfection.noisy && config.sensors.encoder_counts_per_rev > 0.0
                     ? kTwoPi / config.sensors.encoder_counts_per_rev
                     : 0.0),
      encoder_noise_rad_(imperfection.noisy ? config.sensors.encoder_noise_rad : 0.0),
      current_noise_A_(imperfection.noisy ? config.sensors.current_noise_A : 0.0),
      noise_(noise) {}

void Drive::place(double angle_rad) noexcept {
  position_rad_ = encoder_reading_rad(angle_rad);
  velocity_radps_ = 0.0;
}

void Drive::command(const MotorCommand& command, bool enabled) noexcept {
  command_ = command;
  enabled_ = enabled;
}

void Drive::step() noexcept {
  double demand_Nm = 0.0;
  if (enabled_) {
    demand_Nm = command_.kp_Nm_per_rad * (command_.position_rad - position_rad_) +
                command_.kd_Nm_s_per_rad * (command_.velocity_radps - velocity_radps_) + command_.torque_Nm;
    demand_Nm = std::clamp(demand_Nm, -motor_.torque_limit_Nm, motor_.torque_limit_Nm);
  }
  nominal_torque_Nm_ = demand_Nm + (nominal_torque_Nm_ - demand_Nm) * lag_decay_;
}

double Drive::encoder_reading_rad(double angle_rad) noexcept {
  if (encoder_noise_rad_ > 0.0) angle_rad += encoder_noise_rad_ * noise_.encoder.normal();
  return count_rad_ > 0.0 ? count_rad_ * std::round(angle_rad / count_rad_) : angle_rad;
}

void Drive::measure(double angle_rad) noexcept {
  const double before_rad = position_rad_;
  position_rad_ = encoder_reading_rad(angle_rad);
  velocity_radps_ += velocity_gain_ * ((position_rad_ - before_rad) / Plant::kStep_s - velocity_radps_);
  current_A_ = nominal_torque_Nm_ / motor_.torque_constant_Nm_per_A + imperfection_.current_offset_A;
  if (current_noise_A_ > 0.0) current_A_ += current_noise_A_ * noise_.current.normal();
}

MotorSample Drive::sample(std::int64_t time_ns) const noexcept {
  return {.time_ns = time_ns,
          .position_rad = position_rad_,
          .velocity_radps = velocity_radps_,
          .current_A = current_A_,
          .temperature_C = kTemperature_C,
          .bus_voltage_V = kBusVoltage_V,
          .error_code = 0,
          .fresh = true};
}

}  // namespace sandhopper
