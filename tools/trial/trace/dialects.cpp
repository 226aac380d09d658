#include "tools/trial/trace/dialects.hpp"

#include <fmt/format.h>
#include <linux/can.h>

#include <algorithm>
#include <optional>

#include "drivers/can/drive_error.hpp"
#include "drivers/can/servo_protocol.hpp"

namespace sandhopper::trace {
namespace {

constexpr std::uint64_t kFewestReplies = 10;
constexpr int kLastDrive = 0x7E;
constexpr std::uint32_t kLastServoMode = 6;

// First bytes and lengths of the frames with one standard identifier.
struct StandardId {
  std::uint64_t frames = 0;
  std::uint8_t first = 0;
  bool like_replies = true;

  void take(const Frame& f) {
    if (frames++ == 0) first = f.data[0];
    const bool error_code = f.length < 8 || f.data[7] < kDriveErrors.size();
    like_replies &= f.length >= 6 && f.length <= 8 && f.data[0] == first && first >= 1 &&
                    first <= kLastDrive && error_code;
  }
};

std::size_t servo_command_bytes(std::uint32_t mode) {
  constexpr std::uint32_t kSetOrigin = 5, kPositionSpeed = 6;
  if (mode == kPositionSpeed) return 8;
  return mode == kSetOrigin ? 1 : 4;
}

void take_extended(const Frame& frame, DialectsSeen& seen) {
  const auto id = frame.id & CAN_EFF_MASK;
  const int drive = static_cast<int>(id & 0xFFU);
  const auto mode = id >> 8U;
  if (drive == 0) return;
  if ((id & ~0xFFU) == kServoStatus && frame.length == 8) ++seen.status[drive];
  if (mode == static_cast<std::uint32_t>(ServoMode::mit) && frame.length == 8) seen.v3_commands.insert(drive);
  if (mode <= kLastServoMode && frame.length == servo_command_bytes(mode)) seen.servo_commands.insert(drive);
}

const char* status_dialect(const DialectsSeen& seen, int drive) {
  if (seen.v3_commands.contains(drive)) return "v3";
  return seen.servo_commands.contains(drive) ? "servo" : "servo or v3";
}

std::string cure_for_status(const std::string& dialect) {
  if (dialect != "servo or v3")
    return fmt::format("set dialect = \"{}\" for this motor in robot.toml, if that is what the drive speaks",
                       dialect);
  return "set dialect in robot.toml: \"servo\" if the drive sends these frames by itself (board V1/V2), "
         "\"v3\" "
         "if each answers a command (board V3)";
}

// Finding for a configured drive that uses another dialect.
std::optional<Finding> another_dialect(const DialectsSeen& seen, const CubeMarsConfig& motor,
                                       std::uint64_t replies) {
  const std::string who = fmt::format("motor {}: drive {}", motor.name, motor.can_id);
  const char* const configured = EnumNames<Dialect>::value[static_cast<std::size_t>(motor.dialect)].data();
  const auto status = seen.status.find(motor.can_id);
  const auto mit = seen.mit_replies.find(motor.can_id);
  if (motor.dialect == Dialect::mit && status != seen.status.end()) {
    const std::string dialect = status_dialect(seen, motor.can_id);
    return Finding{
        "another_dialect",
        fmt::format("{} speaks {}: {} status frames on extended {:04X}; configured is \"mit\"", who, dialect,
                    status->second, kServoStatus | static_cast<unsigned>(motor.can_id)),
        cure_for_status(dialect), false};
  }
  if (motor.dialect != Dialect::mit && replies == 0 && mit != seen.mit_replies.end())
    return Finding{"another_dialect",
                   fmt::format("{} speaks mit: {} replies on standard {:03X}; configured is \"{}\"", who,
                               mit->second, seen.mit_reply_id.at(motor.can_id), configured),
                   "set dialect = \"mit\" for this motor in robot.toml, if that is what the drive speaks",
                   false};
  const bool v3 = seen.v3_commands.contains(motor.can_id), servo = seen.servo_commands.contains(motor.can_id);
  if ((motor.dialect == Dialect::servo && v3 && !servo) || (motor.dialect == Dialect::v3 && servo && !v3))
    return Finding{
        "another_dialect",
        fmt::format("{} is commanded as {}; configured is \"{}\"", who, v3 ? "v3" : "servo", configured),
        fmt::format("set dialect = \"{}\" for this motor in robot.toml", v3 ? "v3" : "servo"), false};
  return std::nullopt;
}

std::string numbers(const std::vector<int>& drives) {
  return fmt::format("{} {}", drives.size() == 1 ? "drive" : "drives", fmt::join(drives, ", "));
}

// Findings for drives that robot.toml does not contain.
Findings strangers(const DialectsSeen& seen, const CanConfig& config, bool any_reply) {
  std::vector<int> configured, status, mit;
  for (std::size_t m = 0; m < static_cast<std::size_t>(config.motor_count); ++m)
    configured.push_back(config.motor[m].can_id);
  const auto unknown = [&](int drive) { return std::ranges::find(configured, drive) == configured.end(); };
  for (const auto& [drive, count] : seen.status)
    if (unknown(drive)) status.push_back(drive);
  for (const auto& [drive, count] : seen.mit_replies)
    if (unknown(drive)) mit.push_back(drive);
  Findings out;
  const auto cure = fmt::format("if it is one of the robot's: set its can_id in robot.toml, which has {}",
                                fmt::join(configured, " and "));
  if (!status.empty())
    out.push_back({"unknown_drives",
                   fmt::format("{} of the servo or v3 dialect send, too (extended 29xx)", numbers(status)),
                   cure, any_reply});
  if (!mit.empty()) {
    std::string ids;
    for (const int drive : mit) ids += fmt::format(" {:03X}", seen.mit_reply_id.at(drive));
    out.push_back({"unknown_drives",
                   fmt::format("frames that look like mit replies of {}, by their first byte, come on{}",
                               numbers(mit), ids),
                   cure + "; and master_id to the identifier of its replies", any_reply});
  }
  return out;
}

}  // namespace

DialectsSeen examine_dialects(const std::vector<Frame>& frames, const Roles& roles, const CanConfig& config) {
  DialectsSeen seen;
  std::map<std::uint32_t, StandardId> standard;
  std::set<std::uint32_t> command_ids;
  for (const auto& motor : config.motor) command_ids.insert(static_cast<std::uint32_t>(motor.can_id));
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const auto& frame = frames[i];
    if (frame.is_error() || roles.parts[i].role == Role::doubled) continue;
    if (roles.parts[i].role == Role::other) ++seen.other[frame.id];
    if (frame.is_remote()) continue;
    if (frame.is_extended())
      take_extended(frame, seen);
    else
      standard[frame.id].take(frame);
  }
  for (const auto& [id, entry] : standard) {
    if (!entry.like_replies || entry.frames < kFewestReplies) continue;
    const bool command = command_ids.contains(id) && entry.first != id;
    if (command) continue;
    seen.mit_replies[entry.first] += entry.frames;
    seen.mit_reply_id[entry.first] = id;
  }
  return seen;
}

Findings dialect_findings(const DialectsSeen& seen, const CanConfig& config,
                          const std::vector<std::uint64_t>& replies) {
  Findings out;
  bool any_reply = false;
  for (std::size_t m = 0; m < static_cast<std::size_t>(config.motor_count); ++m) {
    any_reply |= replies[m] > 0;
    if (const auto finding = another_dialect(seen, config.motor[m], replies[m])) out.push_back(*finding);
  }
  for (auto& finding : strangers(seen, config, any_reply)) out.push_back(finding);
  return out;
}

}  // namespace sandhopper::trace
