#pragma once
#include <linux/can.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "drivers/can/can_config.hpp"
#include "drivers/motor_command.hpp"

namespace sandhopper::bench {

// One CubeMars drive on a bus, at the level of frames: what its manual says it does, written apart from the
// driver's code. It knows no clock: whoever owns it says when something happens. The plant's link turns `sign
// / gear_ratio` of the drive's output, plus the zero offset.
class EmulatedDrive {
 public:
  // The motor on the link's side: what its sensors read now, and what it is told.
  struct Wiring {
    std::function<MotorSample()> sample;
    std::function<void(const MotorCommand& command, bool enabled)> command;
    // Without a frame for so long a drive drops its command; 0: as the dialect's own emulation has it.
    std::int64_t timeout_ns = 0;
  };
  static constexpr std::int64_t kReplyDelay_ns = 220'000;
  static constexpr std::int64_t kNever_ns = INT64_MAX;

  virtual ~EmulatedDrive() = default;

  // A frame that was on the bus at `now_ns`. The answer, if it gets one, is sent kReplyDelay_ns later.
  virtual std::optional<can_frame> receive(const can_frame& frame, std::int64_t now_ns) = 0;

  // When it next does something by itself (status frame, watchdog), and that thing.
  virtual std::int64_t next_own_ns() const { return kNever_ns; }
  virtual std::optional<can_frame> act(std::int64_t now_ns) = 0;
};

// Of the configured dialect.
std::unique_ptr<EmulatedDrive> make_drive(const CubeMarsConfig& config, EmulatedDrive::Wiring wiring);

// State of the drive's output shaft, and big-endian fields of frames; for the drives' own use.
struct OutputState {
  double position_rad, velocity_radps, torque_Nm, current_A;
  double temperature_C, bus_voltage_V;
  std::uint8_t error_code;
};
OutputState output_state(const CubeMarsConfig& config, const MotorSample& link);
double decoded(std::uint64_t bits, int shift, int width, double low, double high);
std::uint64_t encoded(double value, int width, double low, double high);
std::uint64_t bits_of(const can_frame& frame);

}  // namespace sandhopper::bench
