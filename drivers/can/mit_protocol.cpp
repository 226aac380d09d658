#include "drivers/can/mit_protocol.hpp"

#include <algorithm>

namespace sandhopper {

namespace {

struct Field {
  double low;
  double high;
  std::uint32_t max;  // 2^bits - 1
};

constexpr std::uint32_t k12 = 0xFFF;
constexpr std::uint32_t k16 = 0xFFFF;

constexpr Field symmetric(double range, std::uint32_t max) { return {-range, range, max}; }
constexpr Field from_zero(double range, std::uint32_t max) { return {0.0, range, max}; }

std::uint32_t encode(const Field& f, double value) noexcept {
  if (!(value > f.low)) return 0;
  if (value >= f.high) return f.max;
  const double count = (value - f.low) * f.max / (f.high - f.low);
  return std::min(static_cast<std::uint32_t>(count), f.max);
}

double decode(const Field& f, std::uint32_t count) noexcept {
  return f.low + count * (f.high - f.low) / f.max;
}

}  // namespace

MitPayload pack_mit_command(const MitRanges& r, const MitCommand& c) noexcept {
  const auto p = encode(symmetric(r.position_rad, k16), c.position_rad);
  const auto v = encode(symmetric(r.velocity_radps, k12), c.velocity_radps);
  const auto kp = encode(from_zero(r.kp_Nm_per_rad, k12), c.kp_Nm_per_rad);
  const auto kd = encode(from_zero(r.kd_Nm_s_per_rad, k12), c.kd_Nm_s_per_rad);
  const auto t = encode(symmetric(r.torque_Nm, k12), c.torque_Nm);
  MitPayload out{low_byte(p >> 8U),
                 low_byte(p),
                 low_byte(v >> 4U),
                 low_byte(((v & 0xFU) << 4U) | (kp >> 8U)),
                 low_byte(kp),
                 low_byte(kd >> 4U),
                 low_byte(((kd & 0xFU) << 4U) | (t >> 8U)),
                 low_byte(t)};
  // If every field is at full scale the bytes equal the enter, leave or set-zero frame. Then take one count
  // off kp.
  if (is_special(out)) out[4] = 0xFE;
  return out;
}

std::optional<MitReply> unpack_mit_reply(const MitRanges& r, ReplyFlavour flavour,
                                         std::span<const std::uint8_t> b) noexcept {
  if (b.size() < 6 || b.size() > 8) return std::nullopt;
  MitReply out;
  out.drive_id = b[0];
  out.position_rad = decode(symmetric(r.position_rad, k16), (std::uint32_t{b[1]} << 8U) | b[2]);
  out.velocity_radps = decode(symmetric(r.velocity_radps, k12), (std::uint32_t{b[3]} << 4U) | (b[4] >> 4U));
  out.torque_Nm = decode(symmetric(r.torque_Nm, k12), ((std::uint32_t{b[4]} & 0xFU) << 8U) | b[5]);
  if (b.size() > 6) {
    if (flavour == ReplyFlavour::temperature_offset_40) out.temperature_C = b[6] - 40.0;
    if (flavour == ReplyFlavour::temperature) out.temperature_C = b[6];
    if (flavour == ReplyFlavour::bus_voltage)
      out.bus_voltage_V = decode(from_zero(kBusVoltageRange_V, 0xFF), b[6]);
  }
  if (b.size() > 7) out.error_code = b[7];
  return out;
}

MitCommand unpack_mit_command(const MitRanges& r, const MitPayload& b) noexcept {
  MitCommand out;
  out.position_rad = decode(symmetric(r.position_rad, k16), (std::uint32_t{b[0]} << 8U) | b[1]);
  out.velocity_radps = decode(symmetric(r.velocity_radps, k12), (std::uint32_t{b[2]} << 4U) | (b[3] >> 4U));
  out.kp_Nm_per_rad = decode(from_zero(r.kp_Nm_per_rad, k12), ((std::uint32_t{b[3]} & 0xFU) << 8U) | b[4]);
  out.kd_Nm_s_per_rad = decode(from_zero(r.kd_Nm_s_per_rad, k12), (std::uint32_t{b[5]} << 4U) | (b[6] >> 4U));
  out.torque_Nm = decode(symmetric(r.torque_Nm, k12), ((std::uint32_t{b[6]} & 0xFU) << 8U) | b[7]);
  return out;
}

MitPayload pack_mit_reply(const MitRanges& r, ReplyFlavour flavour, const MitReply& reply) noexcept {
  // Add half a count: a drive reports the nearest count, while encode() truncates.
  const auto nearest = [](const Field& f, double value) {
    return encode(f, value + 0.5 * (f.high - f.low) / f.max);
  };
  const auto p = nearest(symmetric(r.position_rad, k16), reply.position_rad);
  const auto v = nearest(symmetric(r.velocity_radps, k12), reply.velocity_radps);
  const auto t = nearest(symmetric(r.torque_Nm, k12), reply.torque_Nm);
  // NaN (not measured) becomes 0.
  const auto raw_byte = [](double value) {
    return value > 0.0 ? low_byte(static_cast<std::uint32_t>(std::min(value + 0.5, 255.0))) : low_byte(0);
  };
  MitPayload out{reply.drive_id,
                 low_byte(p >> 8U),
                 low_byte(p),
                 low_byte(v >> 4U),
                 low_byte(((v & 0xFU) << 4U) | (t >> 8U)),
                 low_byte(t),
                 0,
                 reply.error_code};
  if (flavour == ReplyFlavour::temperature_offset_40) out[6] = raw_byte(reply.temperature_C + 40.0);
  if (flavour == ReplyFlavour::temperature) out[6] = raw_byte(reply.temperature_C);
  if (flavour == ReplyFlavour::bus_voltage)
    out[6] = raw_byte(reply.bus_voltage_V * 255.0 / kBusVoltageRange_V);
  return out;
}

}  // namespace sandhopper
