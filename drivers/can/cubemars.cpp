#include "drivers/can/cubemars.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <stdexcept>

#include "drivers/can/can_socket.hpp"
#include "drivers/clock.hpp"

namespace sandhopper {

namespace {

// On vcan a reply's kernel time stamp may precede the clock reading before sending by up to this much.
constexpr std::int64_t kReplyStampSlack_ns = 1000;
// A reply that has not come within one and a half cycles is lost.
constexpr std::int64_t kPatience_ns = 1'500'000;

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
  if (reply.error_code == 0 && std::abs(reply.position_rad) > kUsablePositionShare * ranges_.position_rad)
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

MotorSample CubeMarsCodec::to_sample(const ServoStatus& status, std::int64_t time_ns) const noexcept {
  const double to_link = config_.sign / config_.gear_ratio;
  MotorSample out;
  out.time_ns = time_ns;
  out.position_rad = config_.zero_offset_rad + to_link * status.position_rad;
  out.velocity_radps = to_link * status.electrical_radps / (config_.pole_pairs * config_.drive_reduction);
  out.current_A = config_.sign * status.current_A;
  out.temperature_C = status.temperature_C;
  out.error_code = status.error_code;
  out.fresh = true;
  return out;
}

std::optional<can_frame> CubeMarsCodec::current_frame(ServoMode mode, double current_A) const noexcept {
  const auto payload = pack_servo_current(current_A);
  can_frame frame{};
  frame.can_id = servo_id(mode, config_.can_id);
  frame.can_dlc = static_cast<std::uint8_t>(payload.size());
  std::ranges::copy(payload, frame.data);
  return frame;
}

std::optional<can_frame> CubeMarsCodec::frame(DriveAction action, const MotorCommand& command,
                                              const MotorSample& newest) const noexcept {
  if (action == DriveAction::none) return std::nullopt;
  const MotorCommand wanted =
      action == DriveAction::run ? command : MotorCommand{.position_rad = newest.position_rad};
  if (config_.dialect == Dialect::mit) {
    if (action == DriveAction::enter) return special_frame(kMitEnter);
    if (action == DriveAction::leave) return special_frame(kMitLeave);
    return command_frame(wanted);
  }
  // Servo and v3 have no enter and leave frames. In servo mode zero current frees the motor.
  if (action == DriveAction::leave && config_.dialect == Dialect::servo)
    return current_frame(ServoMode::current, 0.0);
  if (config_.dialect == Dialect::v3) {
    can_frame out{};
    out.can_id = servo_id(ServoMode::mit, config_.can_id);
    out.can_dlc = 8;
    std::ranges::copy(pack_v3_command(ranges_, to_drive(wanted)), out.data);
    return out;
  }
  if (!finite(wanted)) return current_frame(ServoMode::current, 0.0);
  double torque_Nm = wanted.torque_Nm;
  if (newest.time_ns != 0)  // without a measured state only the feed-forward torque is sent
    torque_Nm += wanted.kp_Nm_per_rad * (wanted.position_rad - newest.position_rad) +
                 wanted.kd_Nm_s_per_rad * (wanted.velocity_radps - newest.velocity_radps);
  const double current_A = config_.sign * torque_Nm / (config_.gear_ratio * config_.torque_constant_Nm_per_A);
  return current_frame(ServoMode::current, current_A);
}

void CubeMarsCodec::add_filters(std::vector<can_filter>& filters) const {
  const auto id = static_cast<canid_t>(config_.can_id);
  for (const canid_t standard : {canid_t{0}, id, static_cast<canid_t>(config_.master_id)})
    filters.push_back(exact_standard_id(standard));
  filters.push_back(exact_extended_id(kServoStatus | id));
  // The echo of a command shows that it has left. The filters above already pass the commands of the MIT
  // dialect.
  if (config_.dialect != Dialect::mit) {
    const auto mode = config_.dialect == Dialect::servo ? ServoMode::current : ServoMode::mit;
    filters.push_back(exact_extended_id(servo_id(mode, config_.can_id) & CAN_EFF_MASK));
  }
}

CubeMarsCodec::Match CubeMarsCodec::match(const can_frame& frame) const noexcept {
  const auto id = static_cast<canid_t>(config_.can_id);
  const bool extended = (frame.can_id & CAN_EFF_FLAG) != 0;
  if (extended && (frame.can_id & CAN_EFF_MASK) != (kServoStatus | id)) return Match::other;
  const bool addressed =
      frame.can_id == 0 || frame.can_id == id || frame.can_id == static_cast<canid_t>(config_.master_id);
  if (!extended && (!addressed || frame.can_dlc == 0 || frame.data[0] != id)) return Match::other;
  if (extended != (config_.dialect != Dialect::mit)) return Match::foreign;
  const auto length = frame.can_dlc;
  const bool right = extended ? length == 8 : length >= 6 && length <= 8;
  return right ? Match::reply : Match::malformed;
}

bool CubeMarsCodec::is_command_id(canid_t id) const noexcept {
  const auto drive = static_cast<canid_t>(config_.can_id);
  if (config_.dialect == Dialect::mit) return id == drive;
  if ((id & ~CAN_EFF_MASK) != CAN_EFF_FLAG || (id & 0xFFU) != drive) return false;
  constexpr canid_t kLastServoMode = 6;
  const auto mode = (id & CAN_EFF_MASK) >> 8U;
  return config_.dialect == Dialect::v3 ? mode == static_cast<canid_t>(ServoMode::mit)
                                        : mode <= kLastServoMode;
}

MotorSample CubeMarsCodec::sample_of(const can_frame& frame, std::int64_t time_ns) const noexcept {
  if (config_.dialect != Dialect::mit)
    return to_sample(unpack_servo_status(payload_of(frame)).value_or(ServoStatus{}), time_ns);
  return to_sample(unpack_mit_reply(ranges_, config_.reply, payload_of(frame)).value_or(MitReply{}), time_ns);
}

CubeMarsBus::CubeMarsBus(const CanConfig& config)
    : codecs_(checked(config).motor.begin(), config.motor.begin() + config.motor_count) {}

std::vector<can_filter> CubeMarsBus::filters() const {
  std::vector<can_filter> out;
  for (const auto& codec : codecs_) codec.add_filters(out);
  const auto key = [](const can_filter& f) { return f.can_id; };
  std::ranges::sort(out, {}, key);
  const auto same = [](const can_filter& a, const can_filter& b) { return a.can_id == b.can_id; };
  out.erase(std::unique(out.begin(), out.end(), same), out.end());
  return out;
}

bool CubeMarsBus::outstanding(Side side, std::int64_t now_ns) const noexcept {
  const auto& o = outstanding_[index(side)];
  return codecs_[index(side)].answers_commands() && o.waiting && now_ns - o.sent_ns < kPatience_ns;
}

void CubeMarsBus::command_sent(Side side, std::int64_t time_ns) noexcept {
  if (!codecs_[index(side)].answers_commands()) return;
  auto& o = outstanding_[index(side)];
  if (o.waiting) ++counters_[index(side)].missed;
  o = {true, o.waiting, time_ns, o.sent_ns};
}

// A reply that the kernel stamped before the newest command left answers the previous command. Then this
// process was late, not the drive.
std::int64_t CubeMarsBus::state_time(std::size_t i, std::int64_t time_ns) noexcept {
  if (!codecs_[i].answers_commands()) return time_ns;
  auto& o = outstanding_[i];
  const auto delay_ns = to_ns(codecs_[i].config().state_delay_s);
  if (o.waiting && time_ns + kReplyStampSlack_ns >= o.sent_ns) {
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
  using Match = CubeMarsCodec::Match;
  for (std::size_t i = 0; i < codecs_.size(); ++i) {
    const auto match = codecs_[i].match(frame);
    if (match == Match::other) continue;
    if (match != Match::reply) {
      counters_[i].foreign += match == Match::foreign;
      ++counters_[i].rejected;
      return std::nullopt;
    }
    ++counters_[i].replies;
    auto sample = codecs_[i].sample_of(frame, state_time(i, time_ns));
    const auto& c = codecs_[i].config();
    if (c.dialect == Dialect::mit)
      sample.position_rad = unwrap_[i].unwrap(sample.position_rad, c.position_range_rad / c.gear_ratio);
    return MotorReading{static_cast<Side>(i), sample};
  }
  ++strangers_;
  return std::nullopt;
}

std::optional<MotorReading> CanTraceDecoder::decode(const can_frame& frame, std::int64_t time_ns,
                                                    FrameDirection direction) noexcept {
  if (direction != FrameDirection::received) {
    for (std::size_t i = 0; i < bus_.motor_count(); ++i) {
      const auto side = static_cast<Side>(i);
      const auto& codec = bus_.codec(side);
      if (!codec.is_command_id(frame.can_id)) continue;
      const bool may_be_reply = codec.match(frame) == CubeMarsCodec::Match::reply;
      if (direction == FrameDirection::unknown && may_be_reply) continue;
      bus_.command_sent(side, time_ns);
      return std::nullopt;
    }
  }
  return bus_.receive(frame, time_ns);
}

}  // namespace sandhopper
