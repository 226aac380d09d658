#include "drivers/can/servo_protocol.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sandhopper {
namespace {

double signed16(std::uint8_t high, std::uint8_t low) noexcept {
  return static_cast<std::int16_t>(static_cast<std::uint16_t>(high << 8U | low));
}

}  // namespace

std::array<std::uint8_t, 4> pack_servo_current(double current_A) noexcept {
  const double limited =
      std::isfinite(current_A) ? std::clamp(current_A, -kServoCurrentRange_A, kServoCurrentRange_A) : 0.0;
  const auto milli = static_cast<std::uint32_t>(static_cast<std::int32_t>(std::lround(1000.0 * limited)));
  return {low_byte(milli >> 24U), low_byte(milli >> 16U), low_byte(milli >> 8U), low_byte(milli)};
}

// v3 has the fields of pack_mit_command in another order.
MitPayload pack_v3_command(const MitRanges& ranges, const MitCommand& command) noexcept {
  const auto b = pack_mit_command(ranges, command);
  const std::uint32_t p = static_cast<std::uint32_t>(b[0]) << 8U | b[1];
  const std::uint32_t v = static_cast<std::uint32_t>(b[2]) << 4U | b[3] >> 4U;
  const std::uint32_t kp = (b[3] & 0xFU) << 8U | b[4];
  const std::uint32_t kd = static_cast<std::uint32_t>(b[5]) << 4U | b[6] >> 4U;
  const std::uint32_t t = (b[6] & 0xFU) << 8U | b[7];
  return {low_byte(kp >> 4U),
          low_byte((kp & 0xFU) << 4U | kd >> 8U),
          low_byte(kd),
          low_byte(p >> 8U),
          low_byte(p),
          low_byte(v >> 4U),
          low_byte((v & 0xFU) << 4U | t >> 8U),
          low_byte(t)};
}

std::optional<ServoStatus> unpack_servo_status(std::span<const std::uint8_t> b) noexcept {
  if (b.size() != 8) return std::nullopt;
  ServoStatus out;
  out.position_rad = 0.1 * signed16(b[0], b[1]) * std::numbers::pi / 180.0;
  out.electrical_radps = 10.0 * signed16(b[2], b[3]) * 2.0 * std::numbers::pi / 60.0;
  out.current_A = 0.01 * signed16(b[4], b[5]);
  out.temperature_C = static_cast<std::int8_t>(b[6]);
  out.error_code = b[7];
  return out;
}

}  // namespace sandhopper
