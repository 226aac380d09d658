#include "tools/trial/trace/misplaced.hpp"

#include <fmt/format.h>
#include <linux/can.h>

#include <algorithm>
#include <optional>

#include "drivers/can/servo_protocol.hpp"

namespace sandhopper::trace {
namespace {

constexpr std::uint8_t kClassicBytes = 8;

// Identifiers of commands and replies, with the flags of linux/can.h.
std::vector<std::uint32_t> identifiers_of(const CubeMarsConfig& motor) {
  const auto id = static_cast<std::uint32_t>(motor.can_id);
  if (motor.dialect != Dialect::mit) return {CAN_EFF_FLAG | kServoStatus | id};
  return {id, static_cast<std::uint32_t>(motor.master_id)};
}

std::string digits(std::uint32_t id) {
  return (id & CAN_EFF_FLAG) != 0 ? fmt::format("{:08X}", id & CAN_EFF_MASK)
                                  : fmt::format("{:03X}", id & CAN_SFF_MASK);
}

Findings fd_findings(const Trace& trace, const CanConfig& config) {
  if (trace.fd_frames == 0) return {};
  std::uint64_t others = trace.fd_frames;
  bool classic_length = true;
  std::string text;
  for (std::size_t m = 0; m < static_cast<std::size_t>(config.motor_count); ++m)
    for (const auto id : identifiers_of(config.motor[m])) {
      const auto found = trace.fd_by_id.find(id);
      if (found == trace.fd_by_id.end()) continue;
      others -= std::min(others, found->second.count);
      classic_length &= found->second.longest <= kClassicBytes;
      text += fmt::format("{}{} on {} of motor {}", text.empty() ? "" : ", ", found->second.count, digits(id),
                          config.motor[m].name);
    }
  Findings out;
  if (!text.empty())
    out.push_back(
        {"fd_frames_of_motors",
         fmt::format("CAN FD frames stand under identifiers of the motors and are not decoded: {}", text),
         fmt::format("the drives speak classic CAN; an adapter or gateway rewrote it: record with a classic "
                     "interface (ip link set can0 type can bitrate 1000000 fd off){}",
                     classic_length
                         ? fmt::format(", or make classic frames of them: sed 's/##[0-9A-Fa-f]/#/' "
                                       "'{}' > classic.log",
                                       trace.file)
                         : ""),
         false});
  if (others > 0)
    out.push_back({"fd_frames", fmt::format("{} CAN FD frames of other nodes, passed over", others)});
  return out;
}

// Extended frames whose number is that of a motor of which no standard frame was seen.
std::optional<Finding> extended_finding(const TraceReport& report, const Trace& trace,
                                        const CanConfig& config) {
  std::string text;
  for (std::size_t m = 0; m < static_cast<std::size_t>(config.motor_count); ++m) {
    const auto& motor = config.motor[m];
    if (motor.dialect != Dialect::mit || report.motors[m].commands + report.motors[m].replies > 0) continue;
    for (const auto id : identifiers_of(motor)) {
      const auto found = report.dialects.other.find(id | CAN_EFF_FLAG);
      if (found == report.dialects.other.end()) continue;
      text += fmt::format("{}{} on {} for {} of motor {}", text.empty() ? "" : ", ", found->second,
                          digits(found->first), digits(id), motor.name);
    }
  }
  if (text.empty()) return std::nullopt;
  return Finding{
      "extended_identifiers",
      fmt::format("frames stand under extended identifiers with the numbers of the motors' standard "
                  "ones and are not decoded: {}",
                  text),
      fmt::format("if the recorder writes every identifier with eight digits, shorten them: sed -E "
                  "'s/ 00000([0-7][0-9A-Fa-f]{{2}})#/ \\1#/' '{}' > standard.log",
                  trace.file),
      false};
}

// Replies of a motor under an identifier that robot.toml does not give it.
Findings elsewhere_findings(const TraceReport& report, const CanConfig& config) {
  Findings out;
  const auto count = static_cast<std::size_t>(config.motor_count);
  const auto replies_on = [&](std::size_t m) -> std::optional<std::uint32_t> {
    const auto& motor = config.motor[m];
    if (motor.dialect != Dialect::mit || report.motors[m].replies > 0) return std::nullopt;
    const auto found = report.dialects.mit_reply_id.find(motor.can_id);
    return found == report.dialects.mit_reply_id.end() ? std::nullopt : std::optional(found->second);
  };
  for (std::size_t m = 0; m < count; ++m) {
    const auto id = replies_on(m);
    if (!id) continue;
    const auto& motor = config.motor[m];
    std::string cure =
        fmt::format("write master_id = {} for motor {} in robot.toml, if that is what is set in its drive",
                    *id, motor.name);
    std::string whose;
    for (std::size_t n = 0; n < count; ++n) {
      const auto& other = config.motor[n];
      if (n == m || static_cast<std::uint32_t>(other.master_id) != *id) continue;
      whose = fmt::format(", the master_id of motor {}", other.name);
      if (replies_on(n) == static_cast<std::uint32_t>(motor.master_id))
        cure = fmt::format(
            "the two are exchanged: write master_id = {} for motor {} and master_id = {} for "
            "motor {} in robot.toml; or exchange the numbers of the drives, if those are wrong",
            *id, motor.name, motor.master_id, other.name);
    }
    out.push_back({"replies_elsewhere",
                   fmt::format("motor {} (can_id {}): {} frames that begin with its number {:02X}, as its "
                               "replies do, come on {}{}; robot.toml has master_id = {} ({}) for it",
                               motor.name, motor.can_id, report.dialects.mit_replies.at(motor.can_id),
                               motor.can_id, digits(*id), whose, motor.master_id,
                               digits(static_cast<std::uint32_t>(motor.master_id))),
                   cure, false});
  }
  return out;
}

}  // namespace

Findings misplaced_findings(const TraceReport& report, const Trace& trace, const CanConfig& config) {
  Findings out = fd_findings(trace, config);
  if (auto finding = extended_finding(report, trace, config)) out.push_back(std::move(*finding));
  for (auto& finding : elsewhere_findings(report, config)) out.push_back(std::move(finding));
  return out;
}

}  // namespace sandhopper::trace
