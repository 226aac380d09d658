#pragma once
#include <optional>
#include <string_view>

#include "config/fields.hpp"
#include "tools/plant/world_config.hpp"

// Tables [sensors] and [spread] of nominal.toml. Every plant accepts every key: those of the simulated robot
// and those of the other plants. Noise: standard deviation of one sample. 0 means: a sample in every row
// (rate), no low-pass (bandwidth), unlimited (range).
namespace sandhopper {

// Keys of [sensors] besides those of the simulated robot (SensorConfig).
struct OtherSensors {
  double tof_range_m = 0.0;
  double encoder_latency_s = 0.0;
  double current_bandwidth_Hz = 0.0;
  double current_range_A = 0.0;
  double load_cell_range_N = 0.0;
  double load_cell_latency_s = 0.0;
  double imu_latency_s = 0.0;
  double mocap_latency_s = 0.0;
  double height_noise_m = 0.0;
  double height_rate_Hz = 0.0;
  double height_bandwidth_Hz = 0.0;
  double height_latency_s = 0.0;
  double height_resolution_m = 0.0;
  double accel_noise_mps2 = 0.0;
  double accel_rate_Hz = 0.0;
  double accel_bandwidth_Hz = 0.0;
  double accel_latency_s = 0.0;
  double accel_range_mps2 = 0.0;
  double pressure_noise_Pa = 0.0;
  double pressure_rate_Hz = 0.0;
  double pressure_bandwidth_Hz = 0.0;
  double pressure_latency_s = 0.0;
  double pressure_range_Pa = 0.0;
  double position_noise_m = 0.0;
  double position_rate_Hz = 0.0;
  double position_latency_s = 0.0;
  double velocity_noise_mps = 0.0;
  double velocity_rate_Hz = 0.0;
  double velocity_bandwidth_Hz = 0.0;
  double velocity_latency_s = 0.0;
  double position_noise_rad = 0.0;
  double position_range_rad = 0.0;
  double position_bits = 0.0;
  double velocity_noise_radps = 0.0;
  double velocity_range_radps = 0.0;
  double velocity_bits = 0.0;
  double torque_noise_Nm = 0.0;
  double torque_rate_Hz = 0.0;
  double torque_bandwidth_Hz = 0.0;
  double torque_latency_s = 0.0;
  double torque_range_Nm = 0.0;
  double torque_bits = 0.0;
  double load_cell_torque_noise_Nm = 0.0;
  double load_cell_torque_range_Nm = 0.0;

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    constexpr Range kAmount{0.0, 1e9};
    constexpr Range kLatency{0.0, 10.0};
    constexpr Range kBits{0.0, 64.0};
    visit("tof_range_m", self.tof_range_m, kAmount);
    visit("encoder_latency_s", self.encoder_latency_s, kLatency);
    visit("current_bandwidth_Hz", self.current_bandwidth_Hz, kAmount);
    visit("current_range_A", self.current_range_A, kAmount);
    visit("load_cell_range_N", self.load_cell_range_N, kAmount);
    visit("load_cell_latency_s", self.load_cell_latency_s, kLatency);
    visit("imu_latency_s", self.imu_latency_s, kLatency);
    visit("mocap_latency_s", self.mocap_latency_s, kLatency);
    visit("height_noise_m", self.height_noise_m, kAmount);
    visit("height_rate_Hz", self.height_rate_Hz, kAmount);
    visit("height_bandwidth_Hz", self.height_bandwidth_Hz, kAmount);
    visit("height_latency_s", self.height_latency_s, kLatency);
    visit("height_resolution_m", self.height_resolution_m, kAmount);
    visit("accel_noise_mps2", self.accel_noise_mps2, kAmount);
    visit("accel_rate_Hz", self.accel_rate_Hz, kAmount);
    visit("accel_bandwidth_Hz", self.accel_bandwidth_Hz, kAmount);
    visit("accel_latency_s", self.accel_latency_s, kLatency);
    visit("accel_range_mps2", self.accel_range_mps2, kAmount);
    visit("pressure_noise_Pa", self.pressure_noise_Pa, kAmount);
    visit("pressure_rate_Hz", self.pressure_rate_Hz, kAmount);
    visit("pressure_bandwidth_Hz", self.pressure_bandwidth_Hz, kAmount);
    visit("pressure_latency_s", self.pressure_latency_s, kLatency);
    visit("pressure_range_Pa", self.pressure_range_Pa, kAmount);
    visit("position_noise_m", self.position_noise_m, kAmount);
    visit("position_rate_Hz", self.position_rate_Hz, kAmount);
    visit("position_latency_s", self.position_latency_s, kLatency);
    visit("velocity_noise_mps", self.velocity_noise_mps, kAmount);
    visit("velocity_rate_Hz", self.velocity_rate_Hz, kAmount);
    visit("velocity_bandwidth_Hz", self.velocity_bandwidth_Hz, kAmount);
    visit("velocity_latency_s", self.velocity_latency_s, kLatency);
    visit("position_noise_rad", self.position_noise_rad, kAmount);
    visit("position_range_rad", self.position_range_rad, kAmount);
    visit("position_bits", self.position_bits, kBits);
    visit("velocity_noise_radps", self.velocity_noise_radps, kAmount);
    visit("velocity_range_radps", self.velocity_range_radps, kAmount);
    visit("velocity_bits", self.velocity_bits, kBits);
    visit("torque_noise_Nm", self.torque_noise_Nm, kAmount);
    visit("torque_rate_Hz", self.torque_rate_Hz, kAmount);
    visit("torque_bandwidth_Hz", self.torque_bandwidth_Hz, kAmount);
    visit("torque_latency_s", self.torque_latency_s, kLatency);
    visit("torque_range_Nm", self.torque_range_Nm, kAmount);
    visit("torque_bits", self.torque_bits, kBits);
    visit("load_cell_torque_noise_Nm", self.load_cell_torque_noise_Nm, kAmount);
    visit("load_cell_torque_range_Nm", self.load_cell_torque_range_Nm, kAmount);
  }
};

// Keys of [spread] besides those of the simulated robot (SpreadConfig): standard deviations between trials.
struct OtherSpread {
  double initial_position_rad = 0.0;
  double accel_bias_mps2 = 0.0;
  std::optional<double> torque_offset_Nm;     // empty: unknown, which is not zero
  std::optional<double> position_offset_rad;  // empty: the same in all trials
  double height_bias_m = 0.0;
  std::optional<double> height_scale_relative;  // empty: unknown, which is not zero
  std::optional<double> release_speed_relative;
  double position_bias_m = 0.0;
  double load_cell_torque_offset_Nm = 0.0;
  double pressure_offset_Pa = 0.0;

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    constexpr Range kAmount{0.0, 1e9};
    visit("initial_position_rad", self.initial_position_rad, kAmount);
    visit("accel_bias_mps2", self.accel_bias_mps2, kAmount);
    visit("torque_offset_Nm", self.torque_offset_Nm, kAmount);
    visit("position_offset_rad", self.position_offset_rad, kAmount);
    visit("height_bias_m", self.height_bias_m, kAmount);
    visit("height_scale_relative", self.height_scale_relative, kAmount);
    visit("release_speed_relative", self.release_speed_relative, kAmount);
    visit("position_bias_m", self.position_bias_m, kAmount);
    visit("load_cell_torque_offset_Nm", self.load_cell_torque_offset_Nm, kAmount);
    visit("pressure_offset_Pa", self.pressure_offset_Pa, kAmount);
  }
};

struct BeliefSensors {
  SensorConfig robot{};
  OtherSensors other{};

  static BeliefSensors without_effect();  // no noise, no delay, no limits

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    SensorConfig::fields(self.robot, visit);
    OtherSensors::fields(self.other, visit);
  }
};

struct BeliefSpread {
  SpreadConfig robot{};
  OtherSpread other{};

  static BeliefSpread without_effect();  // All trials are equal.

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    // A robot is released at rest from a known height; a hand may throw a body from anywhere, so allow more.
    constexpr Range kByHand{0.0, 100.0};
    SpreadConfig::fields(self.robot, [&](std::string_view key, auto& member, Range range) {
      visit(key, member, key == "release_height_m" || key == "release_speed_mps" ? kByHand : range);
    });
    OtherSpread::fields(self.other, visit);
  }
};

}  // namespace sandhopper
