#include "firmware/live_status.hpp"

namespace sandhopper {

LiveStatus live_status(const SensorFrame& frame, const StepOutput& output,
                       const LatencyHistogram& latency) noexcept {
  const Estimate& e = output.estimate;
  LiveStatus s;
  s.time_ns = output.time_ns;
  s.cycle = output.cycle;
  s.state = output.state;
  s.fault = output.fault;
  s.stride = output.stride;
  s.drives_on = output.command.drive != DriveRequest::off;
  s.emergency_stop = frame.emergency_stop;
  s.bus = frame.bus.state;
  // While the estimator runs its newest force is at most a few cycles old.
  constexpr std::int64_t kForceAge_ns = 20'000'000;
  s.estimating = e.force_time_ns != 0 && output.time_ns - e.force_time_ns < kForceAge_ns;
  s.leg_length_m = e.leg_length_m;
  s.body_z_m = e.body_z_m;
  s.foot_z_m = e.foot_z_m;
  s.foot_velocity_mps = e.foot_velocity_mps;
  s.bed_force_N = e.contact_force_N;
  s.load_cell_N = s.estimating ? e.load_cell_force_N : frame.load_cell.force_N;
  for (std::size_t i = 0; i < kMotorCount; ++i) {
    s.motor_position_rad[i] = frame.motor[i].position_rad;
    s.motor_current_A[i] = frame.motor[i].current_A;
    s.motor_temperature_C[i] = frame.motor[i].temperature_C;
    s.bus_voltage_V[i] = frame.motor[i].bus_voltage_V;
  }
  s.overruns = frame.overruns;
  s.late_us = latency.last_us();
  s.worst_us = latency.largest_us();
  s.late_octaves = latency.octaves();
  return s;
}

}  // namespace sandhopper
