#pragma once
#include <array>
#include <cstdint>

#include "config/fields.hpp"
#include "drivers/samples.hpp"
#include "firmware/realtime.hpp"
#include "firmware/records.hpp"
#include "firmware/sensor_frame.hpp"

namespace sandhopper {

// Values of a running cycle for an operator's display. The cycle's thread publishes one each turn through
// Latest<LiveStatus> (a copy, no wait). `estimating` is false while the estimator is off (idle, zero check):
// heights and forces are then old values. While `estimating`, the tare is removed from `load_cell_N`;
// otherwise it is the raw sample.
struct LiveStatus {
  std::int64_t time_ns = 0;
  std::uint64_t cycle = 0;
  State state = State::idle;
  Fault fault = Fault::none;
  std::uint32_t stride = 0;
  bool drives_on = false;
  bool emergency_stop = false;
  BusState bus = BusState::active;
  bool estimating = false;
  double leg_length_m = 0.0;
  double body_z_m = 0.0;
  double foot_z_m = 0.0;
  double foot_velocity_mps = 0.0;
  double bed_force_N = 0.0;  // momentum observer
  double load_cell_N = 0.0;
  std::array<double, kMotorCount> motor_position_rad{};
  std::array<double, kMotorCount> motor_current_A{};
  std::array<double, kMotorCount> motor_temperature_C{};
  std::array<double, kMotorCount> bus_voltage_V{};
  std::uint32_t overruns = 0;
  double late_us = 0.0;  // lateness of this cycle's wake-up
  double worst_us = 0.0;
  std::array<std::uint64_t, LatencyHistogram::kOctaves> late_octaves{};  // histogram of the cycles' lateness

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("time_ns", self.time_ns);
    visit("cycle", self.cycle);
    visit("state", self.state);
    visit("fault", self.fault);
    visit("stride", self.stride);
    visit("drives_on", self.drives_on);
    visit("emergency_stop", self.emergency_stop);
    visit("bus", self.bus);
    visit("estimating", self.estimating);
    visit("leg_length_m", self.leg_length_m);
    visit("body_z_m", self.body_z_m);
    visit("foot_z_m", self.foot_z_m);
    visit("foot_velocity_mps", self.foot_velocity_mps);
    visit("bed_force_N", self.bed_force_N);
    visit("load_cell_N", self.load_cell_N);
    visit("motor_position_rad", self.motor_position_rad);
    visit("motor_current_A", self.motor_current_A);
    visit("motor_temperature_C", self.motor_temperature_C);
    visit("bus_voltage_V", self.bus_voltage_V);
    visit("overruns", self.overruns);
    visit("late_us", self.late_us);
    visit("worst_us", self.worst_us);
    visit("late_octaves", self.late_octaves);
  }
};

// Made from the input and output of a turn of the cycle and the wake-up latencies.
LiveStatus live_status(const SensorFrame& frame, const StepOutput& output,
                       const LatencyHistogram& latency) noexcept;

}  // namespace sandhopper
