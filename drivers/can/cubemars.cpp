#include "drivers/can/cubemars.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <stdexcept>

#include "drivers/can/can_socket.hpp"
#include "drivers/clock.hpp"

namespace sandhopper {

namespace {

constexpr canid_t kServoStatus = 0x2900;
constexpr double kNearRangeEnd = 0.88;  // of the position range: 11 rad of 12.5
// Kernel stamps of vcan and of the clock read before sending may swap within this.
constexpr std::int64_t kStampSlack_ns = 1000;

bool finite(const MotorCommand& c) noexcept {
  return std::isfinite(c.position_rad) && std::isfinite(c.velocity_radps) && std::isfinite(c.kp_Nm_per_rad) &&
         std::isfinite(c.kd_Nm_s_per_rad) && std::isfinite(c.torque_Nm);
}

can_frame standard_frame(int id, const MitPayload& payload) noexcept {
  can_frame frame{};
  frame.can_id = static_cast<canid_t>(id);
  frame.can_dlc = static_cast<std::uint8_t>(payload.size());
  std::ranges::copy(payload, frame.data);
  return frame;
}

std::span<const std::uint8_t> payload_of(const can_frame& frame) noexcept {
  return {frame.data, std::min<std::size_t>(frame.can_dlc, CAN_MAX_DLEN)};
}

const CanConfig& checked(const CanConfig& config) {
  const auto refuse = [](std::string_view key, std::string_view text) {
    throw std::invalid_argument("can." + std::string(key) + ": " + std::string(text));
  };
  config.check(refuse);
  return config;
}

}  // namespace

CubeMarsCodec::CubeMarsCodec(const CubeMarsConfig& config)
    : config_(config),
      ranges_{config.position_range_rad, config.velocity_range_radps, config.kp_range_Nm_per_rad,
              config.kd_range_Nm_s_per_rad, config.torque_range_Nm},
      torque_to_drive_(config.sign / config.gear_ratio * config.drive_torque_constant_Nm_per_A /
                       config.torque_constant_Nm_per_A) {
  config.check([&](std::string_view key, std::string_view text) {
    throw std::invalid_argument("motor \"" + config.name + "\", " + std::string(key) + ": " +
                                std::string(text));
  });
}

MitCommand CubeMarsCodec::to_drive(const MotorCommand& c) const noexcept {
  if (!finite(c)) return {};
  const double to_drive = config_.sign * config_.gear_ratio;
  const double gain = std::abs(torque_to_drive_) / config_.gear_ratio;
  return {to_drive * (c.position_rad - config_.zero_offset_rad), to_drive * c.velocity_radps,
          gain * c.kp_Nm_per_rad, gain * c.kd_Nm_s_per_rad, torque_to_drive_ * c.torque_Nm};
}

MotorCommand CubeMarsCodec::to_link(const MitCommand& c) const noexcept {
  const double to_link = config_.sign / config_.gear_ratio;
  const double gain = std::abs(torque_to_drive_) / config_.gear_ratio;
  return {config_.zero_offset_rad + to_link * c.position_rad, to_link * c.velocity_radps,
          c.kp_Nm_per_rad / gain, c.kd_Nm_s_per_rad / gain, c.torque_Nm / torque_to_drive_};
}

MotorSample CubeMarsCodec::to_sample(const MitReply& reply, std::int64_t time_ns) const noexcept {
  const double to_link = config_.sign / config_.gear_ratio;
  MotorSample out;
  out.time_ns = time_ns;
  out.position_rad = config_.zero_offset_rad + to_link * reply.position_rad;
  out.velocity_radps = to_link * reply.velocity_radps;
  out.current_A = config_.sign * reply.torque_Nm / config_.drive_torque_constant_Nm_per_A;
  out.temperature_C = reply.temperature_C;
  out.bus_voltage_V = reply.bus_voltage_V;
  out.error_code = reply.error_code;
  if (reply.error_code == 0 && std::abs(reply.position_rad) > kNearRangeEnd * ranges_.position_rad)
    out.error_code = kErrorPositionNearRangeEnd;
  out.fresh = true;
  return out;
}

MitReply CubeMarsCodec::to_reply(const MotorSample& s) const noexcept {
  const double to_drive = config_.sign * config_.gear_ratio;
  return {static_cast<std::uint8_t>(config_.can_id),
          to_drive * (s.position_rad - config_.zero_offset_rad),
          to_drive * s.velocity_radps,
          config_.sign * s.current_A * config_.drive_torque_constant_Nm_per_A,
          s.temperature_C,
          s.bus_voltage_V,
          s.error_code};
}

can_frame CubeMarsCodec::command_frame(const MotorCommand& command) const noexcept {
  return standard_frame(config_.can_id, pack_mit_command(ranges_, to_drive(command)));
}

can_frame CubeMarsCodec::special_frame(const MitPayload& payload) const noexcept {
  return standard_frame(config_.can_id, payload);
}

CubeMarsBus::CubeMarsBus(const CanConfig& config)
    : codecs_(checked(config).motor.begin(), config.motor.begin() + config.motor_count) {}

std::vector<can_filter> CubeMarsBus::filters() const {
  std::vector<canid_t> ids{0};
  for (const auto& codec : codecs_)
    for (const int id : {codec.config().can_id, codec.config().master_id})
      ids.push_back(static_cast<canid_t>(id));
  std::ranges::sort(ids);
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  std::vector<can_filter> out;
  out.reserve(ids.size() + codecs_.size());
  for (const auto id : ids) out.push_back(exact_standard_id(id));
  for (const auto& codec : codecs_)
    out.push_back(exact_extended_id(kServoStatus | static_cast<canid_t>(codec.config().can_id)));
  return out;
}

void CubeMarsBus::command_sent(Side side, std::int64_t time_ns) noexcept {
  auto& o = outstanding_[index(side)];
  if (o.waiting) ++counters_[index(side)].missed;
  o = {true, o.waiting, time_ns, o.sent_ns};
}

// A reply stamped by the kernel before the newest command left answers the one before it: this process was
// late, not the drive.
std::int64_t CubeMarsBus::state_time(std::size_t i, std::int64_t time_ns) noexcept {
  auto& o = outstanding_[i];
  const auto delay_ns = to_ns(codecs_[i].config().state_delay_s);
  if (o.waiting && time_ns + kStampSlack_ns >= o.sent_ns) {
    o.waiting = false;
    o.previous_missed = false;
    return o.sent_ns + delay_ns;
  }
  if (o.previous_missed) {
    o.previous_missed = false;
    --counters_[i].missed;
    return o.previous_ns + delay_ns;
  }
  ++counters_[i].unsolicited;
  return time_ns;
}

std::optional<MotorReading> CubeMarsBus::receive(const can_frame& frame, std::int64_t time_ns) noexcept {
  for (std::size_t i = 0; i < codecs_.size(); ++i) {
    const auto& c = codecs_[i].config();
    const auto can_id = static_cast<canid_t>(c.can_id);
    if ((frame.can_id & CAN_EFF_FLAG) != 0) {
      if ((frame.can_id & CAN_EFF_MASK) != (kServoStatus | can_id)) continue;
      ++counters_[i].foreign;
      ++counters_[i].rejected;
      return std::nullopt;
    }
    const bool addressed =
        frame.can_id == 0 || frame.can_id == can_id || frame.can_id == static_cast<canid_t>(c.master_id);
    if (!addressed || frame.can_dlc == 0 || frame.data[0] != can_id) continue;
    const auto reply = unpack_mit_reply(codecs_[i].ranges(), c.reply, payload_of(frame));
    if (!reply) {
      ++counters_[i].rejected;
      return std::nullopt;
    }
    ++counters_[i].replies;
    return MotorReading{static_cast<Side>(i), codecs_[i].to_sample(*reply, state_time(i, time_ns))};
  }
  ++strangers_;
  return std::nullopt;
}

std::optional<MotorReading> CanTraceDecoder::decode(const can_frame& frame, std::int64_t time_ns,
                                                    FrameDirection direction) noexcept {
  if (direction != FrameDirection::received) {
    for (std::size_t i = 0; i < bus_.motor_count(); ++i) {
      const auto side = static_cast<Side>(i);
      const auto can_id = static_cast<canid_t>(bus_.codec(side).config().can_id);
      if (frame.can_id != can_id) continue;
      if (direction == FrameDirection::unknown && frame.data[0] == can_id) continue;
      bus_.command_sent(side, time_ns);
      return std::nullopt;
    }
  }
  return bus_.receive(frame, time_ns);
}

}  // namespace sandhopper
