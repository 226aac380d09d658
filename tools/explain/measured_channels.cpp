#include "tools/explain/measured_channels.hpp"

#include <array>
#include <cmath>
#include <limits>

namespace sandhopper {
namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

// A cycle, the one before it (itself for the first), and the first one of the recording.
struct Row {
  const SensorFrame& frame;
  const StepOutput& output;
  const SensorFrame& before;
  const SensorFrame& first;
  State last;  // of the cycle before

  // The estimator rests in idle and from the cycle after a fault on: its values are then of earlier.
  bool estimating() const {
    const bool rests = output.state == State::idle || (output.state == State::fault && last == State::fault);
    return !rests && output.estimate.leg_length_m != 0.0;
  }
};

struct Channel {
  const char* name;
  double (*value)(const Row&);
};

// Age of the newest sample; a device that never delivered has none.
template <class Sample>
double age_s(const Row& row, const Sample& sample) {
  return sample.time_ns == 0 ? kNothing : 1e-9 * static_cast<double>(row.frame.time_ns - sample.time_ns);
}

template <class Sample>
double fresh(const Sample& sample, double value) {
  return sample.fresh ? value : kNothing;
}

double grown(std::uint32_t now, std::uint32_t first) { return static_cast<double>(now - first); }

template <std::size_t i>
constexpr std::array kMotorChannels{
    Channel{i == 0 ? "motor_left_position_rad" : "motor_right_position_rad",
            [](const Row& r) { return fresh(r.frame.motor[i], r.frame.motor[i].position_rad); }},
    Channel{i == 0 ? "motor_left_velocity_radps" : "motor_right_velocity_radps",
            [](const Row& r) { return fresh(r.frame.motor[i], r.frame.motor[i].velocity_radps); }},
    Channel{i == 0 ? "motor_left_current_A" : "motor_right_current_A",
            [](const Row& r) { return fresh(r.frame.motor[i], r.frame.motor[i].current_A); }},
    Channel{i == 0 ? "motor_left_temperature_C" : "motor_right_temperature_C",
            [](const Row& r) { return fresh(r.frame.motor[i], r.frame.motor[i].temperature_C); }},
    Channel{i == 0 ? "motor_left_voltage_V" : "motor_right_voltage_V",
            [](const Row& r) { return fresh(r.frame.motor[i], r.frame.motor[i].bus_voltage_V); }},
    Channel{i == 0 ? "motor_left_reply_age_s" : "motor_right_reply_age_s",
            [](const Row& r) { return age_s(r, r.frame.motor[i]); }},
    Channel{i == 0 ? "command_left_torque_Nm" : "command_right_torque_Nm",
            [](const Row& r) { return r.output.command.motor[i].torque_Nm; }},
    Channel{i == 0 ? "command_left_damping_Nm_s_per_rad" : "command_right_damping_Nm_s_per_rad",
            [](const Row& r) { return r.output.command.motor[i].kd_Nm_s_per_rad; }}};

constexpr std::array kSensorChannels{
    Channel{"imu_body_accel_z_mps2",
            [](const Row& r) { return fresh(r.frame.imu_body, r.frame.imu_body.accel_mps2[2]); }},
    Channel{"imu_foot_accel_z_mps2",
            [](const Row& r) { return fresh(r.frame.imu_foot, r.frame.imu_foot.accel_mps2[2]); }},
    Channel{"imu_body_gyro_x_radps",
            [](const Row& r) { return fresh(r.frame.imu_body, r.frame.imu_body.gyro_radps[0]); }},
    Channel{"imu_body_gyro_y_radps",
            [](const Row& r) { return fresh(r.frame.imu_body, r.frame.imu_body.gyro_radps[1]); }},
    Channel{"tof_height_m", [](const Row& r) { return fresh(r.frame.tof, r.frame.tof.height_m); }},
    Channel{"load_cell_N", [](const Row& r) { return fresh(r.frame.load_cell, r.frame.load_cell.force_N); }},
    Channel{"imu_body_age_s", [](const Row& r) { return age_s(r, r.frame.imu_body); }},
    Channel{"imu_foot_age_s", [](const Row& r) { return age_s(r, r.frame.imu_foot); }},
    Channel{"tof_age_s", [](const Row& r) { return age_s(r, r.frame.tof); }},
    Channel{"load_cell_age_s", [](const Row& r) { return age_s(r, r.frame.load_cell); }}};

constexpr std::array kOtherChannels{
    Channel{"bus_errors", [](const Row& r) { return grown(r.frame.bus.errors, r.first.bus.errors); }},
    Channel{"bus_no_acknowledge",
            [](const Row& r) { return grown(r.frame.bus.no_acknowledge, r.first.bus.no_acknowledge); }},
    Channel{"bus_send_failures",
            [](const Row& r) { return grown(r.frame.bus.send_failures, r.first.bus.send_failures); }},
    Channel{"bus_overflows",
            [](const Row& r) { return grown(r.frame.bus.receive_overflows, r.first.bus.receive_overflows); }},
    Channel{"bus_rejected",
            [](const Row& r) {
              return grown(r.frame.bus.rejected[0], r.first.bus.rejected[0]) +
                     grown(r.frame.bus.rejected[1], r.first.bus.rejected[1]);
            }},
    Channel{"bus_unsolicited",
            [](const Row& r) {
              return grown(r.frame.bus.unsolicited[0], r.first.bus.unsolicited[0]) +
                     grown(r.frame.bus.unsolicited[1], r.first.bus.unsolicited[1]);
            }},
    Channel{"bus_state", [](const Row& r) { return static_cast<double>(r.frame.bus.state); }},
    Channel{"emergency_stop", [](const Row& r) { return r.frame.emergency_stop ? 1.0 : 0.0; }},
    Channel{"cycle_step_s",
            [](const Row& r) { return 1e-9 * static_cast<double>(r.frame.time_ns - r.before.time_ns); }},
    Channel{"estimate_leg_length_m",
            [](const Row& r) { return r.estimating() ? r.output.estimate.leg_length_m : kNothing; }},
    Channel{"estimate_body_z_m",
            [](const Row& r) { return r.estimating() ? r.output.estimate.body_z_m : kNothing; }},
    Channel{"estimate_foot_z_m",
            [](const Row& r) { return r.estimating() ? r.output.estimate.foot_z_m : kNothing; }},
    Channel{"estimate_body_velocity_mps",
            [](const Row& r) { return r.estimating() ? r.output.estimate.body_velocity_mps : kNothing; }},
    Channel{"estimate_foot_velocity_mps",
            [](const Row& r) { return r.estimating() ? r.output.estimate.foot_velocity_mps : kNothing; }},
    Channel{"estimate_contact_force_N",
            [](const Row& r) { return r.estimating() ? r.output.estimate.contact_force_N : kNothing; }}};

template <class Channels>
void add(const Channels& channels, const Recording& recording, ReportData& data) {
  const auto& cycles = recording.cycles;
  for (const Channel& channel : channels) {
    ReportColumn column{channel.name, {}};
    column.values.reserve(cycles.size());
    bool any = false;
    for (std::size_t i = 0; i < cycles.size(); ++i) {
      const SensorFrame& before = cycles[i == 0 ? 0 : i - 1].first;
      const State last = cycles[i == 0 ? 0 : i - 1].second.state;
      const double value =
          channel.value({cycles[i].first, cycles[i].second, before, cycles.front().first, last});
      any = any || std::isfinite(value);
      column.values.push_back(value);
    }
    if (any) data.columns.push_back(std::move(column));
  }
}

}  // namespace

void add_measured_channels(const Recording& recording, ReportData& data) {
  for (const auto& [frame, output] : recording.cycles)
    data.time_s.push_back(1e-9 * static_cast<double>(frame.time_ns - recording.time_ns));
  add(kMotorChannels<0>, recording, data);
  add(kMotorChannels<1>, recording, data);
  add(kSensorChannels, recording, data);
  add(kOtherChannels, recording, data);
}

}  // namespace sandhopper
