#include "drivers/transmit_guard/frame_decoder.hpp"

#include <algorithm>
#include <array>
#include <numbers>

namespace sandhopper::transmit {
namespace {

constexpr std::uint32_t kMost16 = 0xFFFF, kMost12 = 0xFFF;
constexpr std::uint32_t kServoCurrent = 0x100, kV3Mit = 0x800, kStatus = 0x2900;
constexpr double kDegree = std::numbers::pi / 180.0;

// All eight bytes; the first one is the most significant.
std::uint64_t big_endian(const can_frame& frame) noexcept {
  std::uint64_t bits = 0;
  for (const std::uint8_t byte : frame.data) bits = bits << 8 | byte;
  return bits;
}

std::uint32_t field(std::uint64_t bits, unsigned lowest_bit, std::uint32_t most) noexcept {
  return static_cast<std::uint32_t>(bits >> lowest_bit) & most;
}

bool middle(std::uint32_t code, std::uint32_t most) noexcept {
  return code == most / 2 || code == most / 2 + 1;
}

// Maps the codes 0 to `most` to -1 to 1.
double centred(std::uint32_t code, std::uint32_t most) noexcept { return (2.0 * code - most) / most; }

double signed16(const can_frame& frame, std::size_t byte) noexcept {
  return static_cast<std::int16_t>(frame.data[byte] << 8 | frame.data[byte + 1]);
}

std::uint32_t command_id_of(const MotorLimits& motor) noexcept {
  if (motor.dialect == Dialect::mit) return motor.can_id;
  const std::uint32_t mode = motor.dialect == Dialect::servo ? kServoCurrent : kV3Mit;
  return CAN_EFF_FLAG | mode | motor.can_id;
}

// Codes nearest to zero: position 7FFF, velocity 7FF, torque 7FF, in the order of the dialect. Servo: 0 mA.
std::array<std::uint8_t, 8> zero_bytes(Dialect dialect) noexcept {
  if (dialect == Dialect::mit) return {0x7F, 0xFF, 0x7F, 0xF0, 0x00, 0x00, 0x07, 0xFF};
  if (dialect == Dialect::v3) return {0x00, 0x00, 0x00, 0x7F, 0xFF, 0x7F, 0xF7, 0xFF};
  return {};
}

}  // namespace

FrameDecoder::FrameDecoder(const MotorLimits& motor) noexcept
    : dialect_(motor.dialect),
      command_id_(command_id_of(motor)),
      can_id_(motor.can_id),
      master_id_(motor.master_id),
      zero_offset_rad_(motor.zero_offset_rad) {
  const double to_link = motor.sign / motor.gear_ratio;
  const double sign_and_gear = motor.sign * motor.gear_ratio;
  // The drive divides torque and gains by the constant that it believes to get a current.
  const double believed = motor.torque_constant_Nm_per_A / motor.drive_torque_constant_Nm_per_A;
  const double gain_to_link = motor.gear_ratio * motor.gear_ratio * believed;
  half_range_rad_ = motor.position_range_rad * to_link;
  half_range_radps_ = motor.velocity_range_radps * to_link;
  half_range_Nm_ = motor.torque_range_Nm * sign_and_gear * believed;
  count_ = {.position_rad = 2.0 * motor.position_range_rad / motor.gear_ratio / kMost16,
            .velocity_radps = 2.0 * motor.velocity_range_radps / motor.gear_ratio / kMost12,
            .kp_Nm_per_rad = motor.kp_range_Nm_per_rad * gain_to_link / kMost12,
            .kd_Nm_s_per_rad = motor.kd_range_Nm_s_per_rad * gain_to_link / kMost12,
            .torque_Nm = 2.0 * motor.torque_range_Nm * motor.gear_ratio * believed / kMost12};
  rad_per_position_ = 0.1 * kDegree * to_link;
  radps_per_speed_ =
      10.0 * 2.0 * std::numbers::pi / 60.0 / motor.pole_pairs / motor.drive_reduction * to_link;
  state_count_ = {.position_rad = count_.position_rad, .velocity_radps = count_.velocity_radps};
  if (dialect_ != Dialect::mit)
    state_count_ = {.position_rad = 0.1 * kDegree / motor.gear_ratio,
                    .velocity_radps = radps_per_speed_ * motor.sign};
  if (dialect_ == Dialect::servo) {
    half_range_Nm_ = 1e-3 * motor.torque_constant_Nm_per_A * sign_and_gear;  // torque of one milliampere
    count_ = {};
    count_.torque_Nm = half_range_Nm_ * motor.sign;
  }
  zero_.can_id = command_id_;
  zero_.can_dlc = dialect_ == Dialect::servo ? 4 : 8;
  std::ranges::copy(zero_bytes(dialect_), zero_.data);
}

Decoded FrameDecoder::command(const can_frame& frame) const noexcept {
  if (frame.can_dlc != zero_.can_dlc) return {};
  if (dialect_ == Dialect::servo) return decode_current(frame);
  const std::uint64_t bits = big_endian(frame);
  if (dialect_ == Dialect::v3)
    return decode_law({.position = field(bits, 24, kMost16),
                       .velocity = field(bits, 12, kMost12),
                       .kp = field(bits, 52, kMost12),
                       .kd = field(bits, 40, kMost12),
                       .torque = field(bits, 0, kMost12)});
  switch (bits) {
    case 0xFFFF'FFFF'FFFF'FFFCU:
      return {.meaning = Meaning::enter};
    case 0xFFFF'FFFF'FFFF'FFFDU:
      return {.meaning = Meaning::leave};
    case 0xFFFF'FFFF'FFFF'FFFEU:
      return {.meaning = Meaning::set_zero};
    default:
      return decode_law({.position = field(bits, 48, kMost16),
                         .velocity = field(bits, 36, kMost12),
                         .kp = field(bits, 24, kMost12),
                         .kd = field(bits, 12, kMost12),
                         .torque = field(bits, 0, kMost12)});
  }
}

Decoded FrameDecoder::decode_law(const Law& codes) const noexcept {
  Decoded out;
  out.position_rad = zero_offset_rad_ + half_range_rad_ * centred(codes.position, kMost16);
  out.velocity_radps = half_range_radps_ * centred(codes.velocity, kMost12);
  out.kp_Nm_per_rad = count_.kp_Nm_per_rad * codes.kp;
  out.kd_Nm_s_per_rad = count_.kd_Nm_s_per_rad * codes.kd;
  out.torque_Nm = half_range_Nm_ * centred(codes.torque, kMost12);
  const bool passive = codes.kp == 0 && middle(codes.torque, kMost12);
  if (passive && codes.kd == 0)
    out.meaning = Meaning::zero;
  else if (passive && middle(codes.velocity, kMost12))
    out.meaning = Meaning::damping;
  else
    out.meaning = Meaning::law;
  return out;
}

Decoded FrameDecoder::decode_current(const can_frame& frame) const noexcept {
  const auto current_mA = static_cast<std::int32_t>(big_endian(frame) >> 32);
  Decoded out;
  out.torque_Nm = half_range_Nm_ * current_mA;
  out.meaning = current_mA == 0 ? Meaning::zero : Meaning::current;
  return out;
}

std::optional<State> FrameDecoder::reply(const can_frame& frame) const noexcept {
  return dialect_ == Dialect::mit ? mit_reply(frame) : status_frame(frame);
}

std::optional<State> FrameDecoder::mit_reply(const can_frame& frame) const noexcept {
  const bool from_drive = frame.can_id == 0 || frame.can_id == can_id_ || frame.can_id == master_id_;
  if (!from_drive || frame.can_dlc < 6 || frame.can_dlc > 8 || frame.data[0] != can_id_) return std::nullopt;
  const std::uint64_t bits = big_endian(frame);
  return State{
      .position_rad = zero_offset_rad_ + half_range_rad_ * centred(field(bits, 40, kMost16), kMost16),
      .velocity_radps = half_range_radps_ * centred(field(bits, 28, kMost12), kMost12)};
}

std::optional<State> FrameDecoder::status_frame(const can_frame& frame) const noexcept {
  if (frame.can_id != (CAN_EFF_FLAG | kStatus | can_id_) || frame.can_dlc != 8) return std::nullopt;
  return State{.position_rad = zero_offset_rad_ + rad_per_position_ * signed16(frame, 0),
               .velocity_radps = radps_per_speed_ * signed16(frame, 2)};
}

}  // namespace sandhopper::transmit
