#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "config/fields.hpp"
#include "drivers/samples.hpp"

// Payloads of the MIT protocol as AK drives of board V1/V2 and KATZ boards speak it: bytes <-> SI units on
// the drive's own side (its sign, its zero, its output shaft). Layout and scaling: CubeMars AK manual
// V1.0.15, section 5.3; B. Katz' motor-controller note.
namespace sandhopper {

constexpr std::uint8_t low_byte(std::uint32_t value) { return static_cast<std::uint8_t>(value & 0xFFU); }

using MitPayload = std::array<std::uint8_t, 8>;

// Full scale of each field: position, velocity and torque span -range..+range, gains 0..range. The manual's
// table gives them per model; some firmware differs by a factor of two, so they are configuration.
struct MitRanges {
  double position_rad = 12.5;
  double velocity_radps = 50.0;
  double kp_Nm_per_rad = 500.0;
  double kd_Nm_s_per_rad = 5.0;
  double torque_Nm = 18.0;
};

struct MitCommand {
  double position_rad = 0.0;
  double velocity_radps = 0.0;
  double kp_Nm_per_rad = 0.0;
  double kd_Nm_s_per_rad = 0.0;
  double torque_Nm = 0.0;
};

// Content of byte 6 of a reply, if the reply has it: not used (plain), temperature as raw - 40 (manuals),
// temperature as raw (some drives), or bus voltage over 0..40 V (KATZ).
enum class ReplyFlavour : std::uint8_t { plain, temperature_offset_40, temperature, bus_voltage };
template <>
struct EnumNames<ReplyFlavour> {
  static constexpr std::array<std::string_view, 4> value{"plain", "temperature_offset_40", "temperature",
                                                         "bus_voltage"};
};

struct MitReply {
  std::uint8_t drive_id = 0;
  double position_rad = 0.0;
  double velocity_radps = 0.0;
  double torque_Nm = 0.0;
  double temperature_C = kNotMeasured;
  double bus_voltage_V = kNotMeasured;
  std::uint8_t error_code =
      0;  // 0 none, 1 motor hot, 2 current, 3 over-, 4 under-voltage, 5 encoder, 6 hot, 7 stall
};

// Packs eight bytes that never equal a special frame. Values are clamped to the ranges; fractions of a count
// are truncated. NaN becomes the low end of its range, so check before.
MitPayload pack_mit_command(const MitRanges& ranges, const MitCommand& command) noexcept;

// Empty for a length other than 6, 7 or 8 bytes. A short reply lacks the fields of bytes 6 and 7.
std::optional<MitReply> unpack_mit_reply(const MitRanges& ranges, ReplyFlavour flavour,
                                         std::span<const std::uint8_t> payload) noexcept;

// Inverse functions, for emulators and recorded traces.
MitCommand unpack_mit_command(const MitRanges& ranges, const MitPayload& payload) noexcept;
MitPayload pack_mit_reply(const MitRanges& ranges, ReplyFlavour flavour, const MitReply& reply) noexcept;

inline constexpr MitPayload kMitEnter{0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFC};
inline constexpr MitPayload kMitLeave{0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFD};
inline constexpr MitPayload kMitSetZero{0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFE};

constexpr bool is_special(const MitPayload& payload) noexcept {
  return payload == kMitEnter || payload == kMitLeave || payload == kMitSetZero;
}

}  // namespace sandhopper
