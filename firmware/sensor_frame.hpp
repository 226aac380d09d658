#pragma once
#include <array>
#include <cstdint>

#include "config/fields.hpp"
#include "drivers/samples.hpp"

namespace sandhopper {

// Request of the operator. It is part of the frame so that a replay has it, too. Valid for one cycle.
enum class Request : std::uint8_t { none, arm, release, stop, disarm };
template <>
struct EnumNames<Request> {
  static constexpr std::array<std::string_view, 5> value{"none", "arm", "release", "stop", "disarm"};
};

// All inputs of one cycle. They are logged, so replaying the frames gives the same bits.
struct SensorFrame {
  std::int64_t time_ns = 0;  // time of the cycle on the 1 ms grid, CLOCK_MONOTONIC
  std::uint64_t cycle = 0;   // number of the grid point since start; a skipped one leaves a gap
  std::array<MotorSample, kMotorCount> motor{};
  ImuSample imu_body{};
  ImuSample imu_foot{};
  TofSample tof{};
  LoadCellSample load_cell{};
  BusSample bus{};
  std::uint32_t overruns = 0;   // cumulative
  bool emergency_stop = false;  // the e-stop line is open or was open since the last cycle; a cut wire counts
                                // as open
  // Time for which the cycle stood still, so that the watchdog took the torque away; 0: it did not.
  std::int64_t watchdog_stall_ns = 0;
  std::int64_t wall_clock_step_ns =
      0;  // CLOCK_REALTIME jumped by this since the last cycle; nothing depends on it
  Request request = Request::none;

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("time_ns", self.time_ns);
    visit("cycle", self.cycle);
    visit("motor", self.motor);
    visit("imu_body", self.imu_body);
    visit("imu_foot", self.imu_foot);
    visit("tof", self.tof);
    visit("load_cell", self.load_cell);
    visit("bus", self.bus);
    visit("overruns", self.overruns);
    visit("emergency_stop", self.emergency_stop);
    visit("watchdog_stall_ns", self.watchdog_stall_ns);
    visit("wall_clock_step_ns", self.wall_clock_step_ns);
    visit("request", self.request);
  }
};

}  // namespace sandhopper
