#pragma once
#include <array>
#include <cstdint>
#include <limits>

#include "config/fields.hpp"
#include "drivers/transmit_guard/rule.hpp"

// Samples of the devices in SI units and in the robot's frame (z up). `time_ns` is the time of measurement in
// nanoseconds of CLOCK_MONOTONIC. `fresh` is true only in the cycle that first sees the sample.
namespace sandhopper {

// A difference of two times of samples, in seconds.
inline double to_s(std::int64_t ns) noexcept { return static_cast<double>(ns) * 1e-9; }

inline constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

enum class Side : std::uint8_t { left, right };
inline constexpr std::size_t kMotorCount = 2;

// One drive's reply. The angle is that of the upper link from straight down and grows as the leg shortens.
// Torque = torque constant x current; it is positive when it shortens the leg. `time_ns` is the instant of
// the measured state (that of the command it answers), not of the reply's arrival.
struct MotorSample {
  std::int64_t time_ns = 0;
  double position_rad = 0.0;
  double velocity_radps = 0.0;
  double current_A = 0.0;
  double temperature_C = kNotMeasured;
  double bus_voltage_V = kNotMeasured;
  std::uint8_t error_code = 0;
  bool fresh = false;

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("time_ns", self.time_ns);
    visit("position_rad", self.position_rad);
    visit("velocity_radps", self.velocity_radps);
    visit("current_A", self.current_A);
    visit("temperature_C", self.temperature_C);
    visit("bus_voltage_V", self.bus_voltage_V);
    visit("error_code", self.error_code);
    visit("fresh", self.fresh);
  }
};

// Specific force (+9.81 m/s^2 along z at rest) and angular rate. `samples` counts the sensor's samples since
// start. At 1666 Hz the sensor is faster than the cycle, so it grows by 1 or 2 per cycle.
struct ImuSample {
  std::int64_t time_ns = 0;
  std::array<double, 3> accel_mps2{};
  std::array<double, 3> gyro_radps{};
  std::uint32_t samples = 0;
  bool fresh = false;

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("time_ns", self.time_ns);
    visit("accel_mps2", self.accel_mps2);
    visit("gyro_radps", self.gyro_radps);
    visit("samples", self.samples);
    visit("fresh", self.fresh);
  }
};

// Height of the body (hip axis) over the surface below the sensor. `status` is the device's own (0: good).
struct TofSample {
  std::int64_t time_ns = 0;
  double height_m = kNotMeasured;
  double amplitude = 0.0;
  std::int16_t status = 0;
  std::uint8_t quality = 0;
  bool fresh = false;

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("time_ns", self.time_ns);
    visit("height_m", self.height_m);
    visit("amplitude", self.amplitude);
    visit("status", self.status);
    visit("quality", self.quality);
    visit("fresh", self.fresh);
  }
};

// Compression of the foot's load cell is positive. The tare is not removed.
struct LoadCellSample {
  std::int64_t time_ns = 0;
  double force_N = 0.0;
  std::uint32_t samples = 0;
  bool fresh = false;

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("time_ns", self.time_ns);
    visit("force_N", self.force_N);
    visit("samples", self.samples);
    visit("fresh", self.fresh);
  }
};

// State that the CAN controller reports (ISO 11898-1 fault confinement).
enum class BusState : std::uint8_t { active, warning, passive, off };
template <>
struct EnumNames<BusState> {
  static constexpr std::array<std::string_view, 4> value{"active", "warning", "passive", "off"};
};

// State of the motors' bus; counts are cumulative since start. `rejected`: frames with a drive's identifier
// that do not match its dialect. `unsolicited`: answers with no command outstanding.
struct BusSample {
  BusState state = BusState::active;
  std::uint32_t send_failures = 0;  // commands the kernel did not take, or that had not left after a cycle
  std::uint32_t receive_overflows = 0;  // dropped by the kernel or the controller
  std::uint32_t no_acknowledge = 0;
  std::uint32_t errors = 0;  // other error frames: protocol, transceiver
  std::array<std::uint32_t, kMotorCount> rejected{};
  std::array<std::uint32_t, kMotorCount> unsolicited{};
  RefusedFrames refused{};  // by the transmit guard

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("state", self.state);
    visit("send_failures", self.send_failures);
    visit("receive_overflows", self.receive_overflows);
    visit("no_acknowledge", self.no_acknowledge);
    visit("errors", self.errors);
    visit("rejected", self.rejected);
    visit("unsolicited", self.unsolicited);
    visit("refused", self.refused);
  }
};

}  // namespace sandhopper
