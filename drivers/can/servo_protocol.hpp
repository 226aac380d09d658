#pragma once
#include <linux/can.h>

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "drivers/can/mit_protocol.hpp"

// Frames of the servo dialect (board V1/V2 in servo mode) and of board V3, which adds MIT as mode 8: extended
// identifier mode << 8 | drive, big-endian payload. CubeMars AK manual V1.0.18 section 4.4, AKA manual V3.0.0
// section 4.
namespace sandhopper {

enum class ServoMode : std::uint8_t { duty = 0, current = 1, current_brake = 2, mit = 8 };

// Identifier 0x2900 | drive of the status frame, which the drive sends.
inline constexpr canid_t kServoStatus = 0x2900;

constexpr canid_t servo_id(ServoMode mode, int drive) noexcept {
  return CAN_EFF_FLAG | static_cast<canid_t>(mode) << 8U | static_cast<canid_t>(drive);
}

// Current or brake current [A], clamped to +-60 A, sent in milliamperes.
std::array<std::uint8_t, 4> pack_servo_current(double current_A) noexcept;

// Payload of mode 8: the fields of MIT mode in the order Kp Kd P V T.
MitPayload pack_v3_command(const MitRanges& ranges, const MitCommand& command) noexcept;

// Content of a status frame. Resolution: position of the output 0.1 deg, speed 10 electrical turns a minute,
// current 0.01 A.
struct ServoStatus {
  double position_rad = 0.0;
  double electrical_radps = 0.0;
  double current_A = 0.0;
  double temperature_C = 0.0;  // of the board
  std::uint8_t error_code = 0;
};

// Empty for a length other than 8 bytes.
std::optional<ServoStatus> unpack_servo_status(std::span<const std::uint8_t> payload) noexcept;

}  // namespace sandhopper
