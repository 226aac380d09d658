#include "tools/virtual_bench/mit_drive.hpp"

#include <algorithm>
#include <cmath>

namespace sandhopper::bench {
namespace {

constexpr std::int64_t kReplyDelay_ns = 220'000;
constexpr std::int64_t kWatchdog_ns = 25'000'000;
constexpr std::int64_t kZeroing_ns = 1'000'000'000;
constexpr double kTemperature_C = 30.0;
constexpr double kBusVoltage_V = 36.0;

// Big-endian bit fields of one frame, counted from the first bit.
std::uint64_t bits_of(const can_frame& frame) {
  std::uint64_t bits = 0;
  for (const auto byte : frame.data) bits = bits << 8 | byte;
  return bits;
}

double decoded(std::uint64_t bits, int shift, int width, double low, double high) {
  const auto largest = (std::uint64_t{1} << width) - 1;
  return low + static_cast<double>(bits >> shift & largest) * (high - low) / static_cast<double>(largest);
}

std::uint64_t encoded(double value, int width, double low, double high) {
  const auto largest = static_cast<double>((std::uint64_t{1} << width) - 1);
  const double share = std::isfinite(value) ? std::clamp((value - low) / (high - low), 0.0, 1.0) : 0.0;
  return static_cast<std::uint64_t>(share * largest);
}

}  // namespace

MitDrive::MitDrive(const Wiring& wiring, Side side, const CubeMarsConfig& config)
    : wiring_(wiring), side_(side), config_(config) {}

MitDrive::State MitDrive::state() const {
  const auto sample = wiring_.world.now().read_motor(side_);
  const double to_drive = config_.sign * config_.gear_ratio;
  return {.position_rad = to_drive * (sample.position_rad - config_.zero_offset_rad) - zero_rad_,
          .velocity_radps = to_drive * sample.velocity_radps,
          .torque_Nm = config_.sign * sample.current_A * config_.drive_torque_constant_Nm_per_A,
          .temperature_C = std::isfinite(sample.temperature_C) ? sample.temperature_C : kTemperature_C,
          .error_code = sample.error_code};
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
      frame.data[6] = static_cast<std::uint8_t>(encoded(kBusVoltage_V, 8, 0.0, 40.0));
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

void MitDrive::receive(const can_frame& frame) {
  const bool mine = frame.can_id == static_cast<canid_t>(config_.can_id) && frame.can_dlc == 8;
  const auto now_ns = wiring_.loop.now_ns();
  if (!mine || now_ns < silent_until_ns_) return;
  last_frame_ns_ = now_ns;
  const auto answer = reply();  // packed before the frame is obeyed
  obey(frame);
  wiring_.loop.at(now_ns + kReplyDelay_ns, [this, answer] {
    if (wiring_.loop.now_ns() >= silent_until_ns_) wiring_.send(answer);
  });
}

void MitDrive::obey(const can_frame& frame) {
  const auto bits = bits_of(frame);
  constexpr std::uint64_t kEnter = ~std::uint64_t{3}, kLeave = kEnter + 1, kSetZero = kEnter + 2;
  if (bits == kEnter) {
    motor_mode_ = true;
    command({});
  } else if (bits == kLeave) {
    motor_mode_ = false;
    command({});
  } else if (bits == kSetZero) {
    zero_rad_ += state().position_rad;
    command({});
    silent_until_ns_ = wiring_.loop.now_ns() + kZeroing_ns;
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
    command({.position_rad = config_.zero_offset_rad + to_link * (position + zero_rad_),
             .velocity_radps = to_link * velocity,
             .kp_Nm_per_rad = kp * torque_to_link * config_.gear_ratio,
             .kd_Nm_s_per_rad = kd * torque_to_link * config_.gear_ratio,
             .torque_Nm = config_.sign * torque * torque_to_link});
  }
}

void MitDrive::command(const MotorCommand& link) {
  wiring_.world.command(side_, link, motor_mode_);
  watch_silence();
}

// One timer that follows the last frame, rather than one a frame.
void MitDrive::watch_silence() {
  if (watched_) return;
  watched_ = true;
  wiring_.loop.at(last_frame_ns_ + kWatchdog_ns, [this] {
    watched_ = false;
    if (wiring_.loop.now_ns() < last_frame_ns_ + kWatchdog_ns) return watch_silence();
    wiring_.world.command(side_, {}, motor_mode_);
  });
}

}  // namespace sandhopper::bench
