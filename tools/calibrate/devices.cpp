#include "tools/calibrate/devices.hpp"

#include <cmath>

#include "drivers/imu/ism330dhcx_protocol.hpp"

namespace sandhopper::calibrate {
namespace {

std::int64_t nanoseconds(double seconds) { return std::llround(seconds * 1e9); }

// Output speed per unit of the reply's velocity field, up to a common factor: only ratios between motors of
// one dialect have a meaning.
double speed_unit(const CubeMarsConfig& motor) {
  return motor.dialect == Dialect::mit ? motor.velocity_range_radps
                                       : 1.0 / (motor.pole_pairs * motor.drive_reduction);
}

}  // namespace

MotorSample converted(const MotorSample& sample, const CubeMarsConfig& from, const CubeMarsConfig& to) {
  const double to_drive = from.sign * from.gear_ratio;
  const double to_link = to.sign / to.gear_ratio;
  MotorSample out = sample;
  out.position_rad = to.zero_offset_rad + to_link * to_drive * (sample.position_rad - from.zero_offset_rad);
  const double speed = from.dialect == to.dialect ? speed_unit(to) / speed_unit(from) : 1.0;
  out.velocity_radps = to_link * to_drive * speed * sample.velocity_radps;
  out.current_A = to.sign * from.sign * sample.current_A;
  out.time_ns += nanoseconds(to.state_delay_s - from.state_delay_s);
  return out;
}

ImuSample converted(const ImuSample& sample, const ImuConfig& from, const ImuConfig& to) {
  ImuSample out = sample;
  out.accel_mps2 = ism330dhcx::calibrated_accel_mps2(ism330dhcx::raw_accel_mps2(sample.accel_mps2, from), to);
  out.gyro_radps = ism330dhcx::calibrated_gyro_radps(ism330dhcx::raw_gyro_radps(sample.gyro_radps, from), to);
  out.time_ns += nanoseconds(from.latency_s - to.latency_s);
  return out;
}

TofSample converted(const TofSample& sample, const TofConfig& from, const TofConfig& to) {
  TofSample out = sample;
  out.height_m += to.mount_offset_m - from.mount_offset_m;
  out.time_ns += nanoseconds(from.latency_s - to.latency_s);
  return out;
}

double load_cell_voltage_V(double force_N, const LoadCellConfig& config) {
  return config.zero_V + force_N / (config.sign * config.scale_N_per_V);
}

LoadCellSample converted(const LoadCellSample& sample, const LoadCellConfig& from, const LoadCellConfig& to) {
  LoadCellSample out = sample;
  out.force_N = to.sign * to.scale_N_per_V * (load_cell_voltage_V(sample.force_N, from) - to.zero_V);
  out.time_ns += nanoseconds(from.latency_s - to.latency_s);
  return out;
}

}  // namespace sandhopper::calibrate
