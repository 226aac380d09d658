#include "tools/virtual_bench/drives/servo_drive.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace sandhopper::bench {
namespace {

constexpr std::int64_t kTimeout_ns = 1'000'000'000;
constexpr double kBrakeKnee_radps = 1.0;  // below, braking fades with the speed

std::int32_t int32_of(const can_frame& frame) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(bits_of(frame) >> 32));
}

std::int16_t int16_of(double value) {
  return static_cast<std::int16_t>(std::lround(std::clamp(value, -32000.0, 32000.0)));
}

void put(can_frame& frame, int at, std::int16_t value) {
  frame.data[at] = static_cast<std::uint8_t>(static_cast<std::uint16_t>(value) >> 8);
  frame.data[at + 1] = static_cast<std::uint8_t>(value & 0xFF);
}

}  // namespace

ServoDrive::ServoDrive(const CubeMarsConfig& config, Wiring wiring)
    : config_(config),
      wiring_(std::move(wiring)),
      timeout_ns_(wiring_.timeout_ns > 0 ? wiring_.timeout_ns : kTimeout_ns) {}

can_frame ServoDrive::status() const {
  const auto now = output_state(config_, wiring_.sample());
  const double erpm =
      now.velocity_radps * 60.0 / (2.0 * std::numbers::pi) * config_.pole_pairs * config_.drive_reduction;
  can_frame frame{};
  frame.can_id = CAN_EFF_FLAG | 0x2900U | static_cast<canid_t>(config_.can_id);
  frame.can_dlc = 8;
  put(frame, 0, int16_of(now.position_rad * 180.0 / std::numbers::pi * 10.0));
  put(frame, 2, int16_of(erpm / 10.0));
  put(frame, 4, int16_of(now.current_A * 100.0));
  frame.data[6] =
      static_cast<std::uint8_t>(static_cast<std::int8_t>(std::clamp(now.temperature_C, -20.0, 127.0)));
  frame.data[7] = now.error_code;
  return frame;
}

std::optional<can_frame> ServoDrive::receive(const can_frame& frame, std::int64_t now_ns) {
  const auto id = frame.can_id & CAN_EFF_MASK;
  if ((frame.can_id & CAN_EFF_FLAG) == 0 || (id & 0xFFU) != static_cast<canid_t>(config_.can_id))
    return std::nullopt;
  const auto answer = status();
  if (!obey(frame)) return std::nullopt;
  last_frame_ns_ = now_ns;
  commanded_ = true;
  if (v3()) return answer;
  return std::nullopt;
}

bool ServoDrive::obey(const can_frame& frame) {
  const auto mode = (frame.can_id & CAN_EFF_MASK) >> 8;
  if (mode == 8 && v3() && frame.can_dlc == 8) {
    obey_mit(bits_of(frame));
    return true;
  }
  if (frame.can_dlc != 4) return false;
  switch (mode) {
    case 0:
      wiring_.command({}, int32_of(frame) != 0);
      return true;
    case 1:
      obey_current(1e-3 * int32_of(frame));
      return true;
    case 2:
      obey_brake(1e-3 * int32_of(frame));
      return true;
    default:
      return false;
  }
}

// The q-axis current makes the torque; the link's calibrated constant says how much.
void ServoDrive::obey_current(double current_A) {
  const double limited = std::clamp(current_A, -60.0, 60.0);
  wiring_.command(
      {.torque_Nm = config_.sign * config_.gear_ratio * limited * config_.torque_constant_Nm_per_A}, true);
}

// Against the motion, and none at rest.
void ServoDrive::obey_brake(double current_A) {
  const double torque =
      config_.gear_ratio * std::clamp(current_A, 0.0, 60.0) * config_.torque_constant_Nm_per_A;
  wiring_.command({.kd_Nm_s_per_rad = torque / kBrakeKnee_radps}, true);
}

void ServoDrive::obey_mit(std::uint64_t bits) {
  const double kp = decoded(bits, 52, 12, 0.0, config_.kp_range_Nm_per_rad);
  const double kd = decoded(bits, 40, 12, 0.0, config_.kd_range_Nm_s_per_rad);
  const double position = decoded(bits, 24, 16, -config_.position_range_rad, config_.position_range_rad);
  const double velocity = decoded(bits, 12, 12, -config_.velocity_range_radps, config_.velocity_range_radps);
  const double torque = decoded(bits, 0, 12, -config_.torque_range_Nm, config_.torque_range_Nm);
  const double to_link = config_.sign / config_.gear_ratio;
  const double torque_to_link =
      config_.gear_ratio * config_.torque_constant_Nm_per_A / config_.drive_torque_constant_Nm_per_A;
  wiring_.command({.position_rad = config_.zero_offset_rad + to_link * position,
                   .velocity_radps = to_link * velocity,
                   .kp_Nm_per_rad = kp * torque_to_link * config_.gear_ratio,
                   .kd_Nm_s_per_rad = kd * torque_to_link * config_.gear_ratio,
                   .torque_Nm = config_.sign * torque * torque_to_link},
                  true);
}

std::int64_t ServoDrive::next_own_ns() const {
  const auto timeout_ns = commanded_ ? last_frame_ns_ + timeout_ns_ : kNever_ns;
  return v3() ? timeout_ns : std::min(timeout_ns, next_status_ns_);
}

std::optional<can_frame> ServoDrive::act(std::int64_t now_ns) {
  if (commanded_ && now_ns >= last_frame_ns_ + timeout_ns_) {
    commanded_ = false;
    wiring_.command({}, false);
  }
  if (v3() || now_ns < next_status_ns_) return std::nullopt;
  const auto period_ns = static_cast<std::int64_t>(1e9 / config_.status_rate_Hz);
  next_status_ns_ = next_status_ns_ == 0 ? now_ns + period_ns : next_status_ns_ + period_ns;
  return status();
}

}  // namespace sandhopper::bench
