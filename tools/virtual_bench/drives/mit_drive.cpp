#include "tools/virtual_bench/drives/mit_drive.hpp"

#include <cmath>
#include <utility>

namespace sandhopper::bench {
namespace {

constexpr std::int64_t kWatchdog_ns = 25'000'000;
constexpr std::int64_t kZeroing_ns = 1'000'000'000;

}  // namespace

MitDrive::MitDrive(const CubeMarsConfig& config, Wiring wiring)
    : config_(config),
      wiring_(std::move(wiring)),
      timeout_ns_(wiring_.timeout_ns > 0 ? wiring_.timeout_ns : kWatchdog_ns) {}

OutputState MitDrive::state() const {
  auto now = output_state(config_, wiring_.sample());
  now.position_rad -= zero_rad_;
  return now;
}

can_frame MitDrive::reply() const {
  const auto now = state();
  const auto fields =
      encoded(now.position_rad, 16, -config_.position_range_rad, config_.position_range_rad) << 24 |
      encoded(now.velocity_radps, 12, -config_.velocity_range_radps, config_.velocity_range_radps) << 12 |
      encoded(now.torque_Nm, 12, -config_.torque_range_Nm, config_.torque_range_Nm);
  can_frame frame{};
  frame.can_id = static_cast<canid_t>(config_.master_id);
  frame.data[0] = static_cast<std::uint8_t>(config_.can_id);
  for (int i = 0; i < 5; ++i) frame.data[1 + i] = static_cast<std::uint8_t>(fields >> (8 * (4 - i)));
  switch (config_.reply) {
    case ReplyFlavour::plain:
      frame.can_dlc = 6;
      return frame;
    case ReplyFlavour::bus_voltage:
      frame.can_dlc = 7;
      frame.data[6] = static_cast<std::uint8_t>(encoded(now.bus_voltage_V, 8, 0.0, 40.0));
      return frame;
    case ReplyFlavour::temperature_offset_40:
    case ReplyFlavour::temperature:
      frame.can_dlc = 8;
      frame.data[6] = static_cast<std::uint8_t>(
          std::lround(now.temperature_C + (config_.reply == ReplyFlavour::temperature ? 0.0 : 40.0)));
      frame.data[7] = now.error_code;
  }
  return frame;
}

std::optional<can_frame> MitDrive::receive(const can_frame& frame, std::int64_t now_ns) {
  const bool mine = frame.can_id == static_cast<canid_t>(config_.can_id) && frame.can_dlc == 8;
  if (!mine || now_ns < silent_until_ns_) return std::nullopt;
  last_frame_ns_ = now_ns;
  commanded_ = true;
  const auto answer = reply();  // packed before the frame is obeyed
  obey(frame, now_ns);
  if (now_ns + kReplyDelay_ns < silent_until_ns_) return std::nullopt;
  return answer;
}

void MitDrive::obey(const can_frame& frame, std::int64_t now_ns) {
  const auto bits = bits_of(frame);
  constexpr std::uint64_t kEnter = ~std::uint64_t{3}, kLeave = kEnter + 1, kSetZero = kEnter + 2;
  if (bits == kEnter) {
    motor_mode_ = true;
    wiring_.command({}, motor_mode_);
  } else if (bits == kLeave) {
    motor_mode_ = false;
    wiring_.command({}, motor_mode_);
  } else if (bits == kSetZero) {
    zero_rad_ += state().position_rad;
    wiring_.command({}, motor_mode_);
    silent_until_ns_ = now_ns + kZeroing_ns;
  } else {
    const double position = decoded(bits, 48, 16, -config_.position_range_rad, config_.position_range_rad);
    const double velocity =
        decoded(bits, 36, 12, -config_.velocity_range_radps, config_.velocity_range_radps);
    const double kp = decoded(bits, 24, 12, 0.0, config_.kp_range_Nm_per_rad);
    const double kd = decoded(bits, 12, 12, 0.0, config_.kd_range_Nm_s_per_rad);
    const double torque = decoded(bits, 0, 12, -config_.torque_range_Nm, config_.torque_range_Nm);
    // The drive turns torque into current with the constant it believes in. On the link's side of the gear a
    // torque grows with the ratio, a gain with its square.
    const double to_link = config_.sign / config_.gear_ratio;
    const double torque_to_link =
        config_.gear_ratio * config_.torque_constant_Nm_per_A / config_.drive_torque_constant_Nm_per_A;
    wiring_.command({.position_rad = config_.zero_offset_rad + to_link * (position + zero_rad_),
                     .velocity_radps = to_link * velocity,
                     .kp_Nm_per_rad = kp * torque_to_link * config_.gear_ratio,
                     .kd_Nm_s_per_rad = kd * torque_to_link * config_.gear_ratio,
                     .torque_Nm = config_.sign * torque * torque_to_link},
                    motor_mode_);
  }
}

std::int64_t MitDrive::next_own_ns() const { return commanded_ ? last_frame_ns_ + timeout_ns_ : kNever_ns; }

std::optional<can_frame> MitDrive::act(std::int64_t now_ns) {
  if (now_ns < next_own_ns()) return std::nullopt;
  commanded_ = false;
  wiring_.command({}, motor_mode_);
  return std::nullopt;
}

}  // namespace sandhopper::bench
