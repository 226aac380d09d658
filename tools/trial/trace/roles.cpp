#include "tools/trial/trace/roles.hpp"

#include <linux/can.h>

#include <algorithm>

#include "drivers/can/cubemars.hpp"
#include "drivers/can/servo_protocol.hpp"
#include "tools/trial/trace/timing.hpp"

namespace sandhopper::trace {
namespace {

constexpr std::uint8_t kCommandBytes = 8;

class MotorFrames {
 public:
  MotorFrames(const CubeMarsConfig& config, std::int64_t longest_reply_ns)
      : codec_(config),
        config_(codec_.config()),
        id_(static_cast<std::uint32_t>(config.can_id)),
        longest_reply_ns_(longest_reply_ns) {}

  bool has_command_id(const Frame& f) const { return codec_.is_command_id(f.id); }
  // Checks identifier and first byte. A frame on the command's identifier may still be a command.
  bool may_be_reply(const Frame& f) const {
    if (f.is_remote() || f.is_error()) return false;
    if (config_.dialect != Dialect::mit) return f.id == (CAN_EFF_FLAG | kServoStatus | id_);
    const bool addressed = f.id == 0 || f.id == id_ || f.id == static_cast<std::uint32_t>(config_.master_id);
    return addressed && f.length > 0 && f.data[0] == id_;
  }
  bool on_shared_id(const Frame& f) const { return config_.dialect == Dialect::mit && f.id == id_; }

  // Assigns roles if both directions use one identifier. `places` are indices into `frames`.
  Evidence share(const std::vector<Frame>& frames, const std::vector<std::size_t>& places,
                 std::vector<Part>& parts) const {
    if (std::ranges::any_of(places, [&](auto i) { return frames[i].direction == CanDirection::sent; })) {
      for (const auto i : places)
        parts[i].role = frames[i].direction == CanDirection::sent ? Role::command : Role::reply;
      return Evidence::direction;
    }
    const auto limit_ns = reply_limit_ns(frames, places);
    if (!limit_ns) {
      for (const auto i : places) parts[i].role = may_be_reply(frames[i]) ? Role::ambiguous : Role::command;
      return Evidence::none;
    }
    bool waiting = false;
    std::int64_t asked_ns = 0;
    for (const auto i : places) {
      const bool in_time = waiting && frames[i].time_ns - asked_ns < *limit_ns;
      const bool short_reply = frames[i].length < kCommandBytes;
      const bool reply = may_be_reply(frames[i]) && (short_reply || in_time);
      parts[i].role = reply ? Role::reply : Role::command;
      waiting = !reply;
      if (!reply) asked_ns = frames[i].time_ns;
    }
    return Evidence::exchange;
  }

 private:
  // Longest time from command to reply: half the period of the commands, or, if a frame is too short for a
  // command, the longest time that the bus can take. Empty if commands and replies do not alternate with
  // uneven steps.
  std::optional<std::int64_t> reply_limit_ns(const std::vector<Frame>& frames,
                                             const std::vector<std::size_t>& places) const {
    std::vector<std::int64_t> certain, all;
    for (const auto i : places) {
      all.push_back(frames[i].time_ns);
      if (!may_be_reply(frames[i])) certain.push_back(frames[i].time_ns);
    }
    if (2 * certain.size() >= places.size()) return median(steps(certain)) / 2;
    if (std::ranges::any_of(places, [&](auto i) { return frames[i].length < kCommandBytes; }))
      return longest_reply_ns_;
    // Most or all first bytes are the drive's number. Then an exchange alternates between a short and a long
    // step.
    const auto step_ns = steps(all);
    std::vector<std::int64_t> shorter, longer;
    for (std::size_t i = 0; i + 1 < step_ns.size(); i += 2) {
      shorter.push_back(std::min(step_ns[i], step_ns[i + 1]));
      longer.push_back(std::max(step_ns[i], step_ns[i + 1]));
    }
    const auto near_ns = median(shorter), far_ns = median(longer);
    if (far_ns - near_ns < kShortestFrame_ns || near_ns > longest_reply_ns_) return std::nullopt;
    return (near_ns + far_ns) / 2;
  }

  CubeMarsCodec codec_;
  const CubeMarsConfig& config_;
  std::uint32_t id_;
  std::int64_t longest_reply_ns_;
};

// True if identifier, length and bytes are equal.
bool same_content(const Frame& a, const Frame& b) {
  return a.id == b.id && a.length == b.length && a.data == b.data;
}

// Marks copies: two different frames of a bus cannot end within the duration of the shortest frame.
void mark_doubled(const std::vector<Frame>& frames, std::vector<Part>& parts) {
  for (std::size_t i = 1; i < frames.size(); ++i) {
    if (frames[i].is_error()) continue;
    for (std::size_t j = i; j-- > 0 && frames[i].time_ns - frames[j].time_ns < kShortestFrame_ns;)
      if (parts[j].role != Role::doubled && same_content(frames[i], frames[j])) {
        parts[i].role = Role::doubled;
        break;
      }
  }
}

Evidence find_roles_of(const MotorFrames& motor, const std::vector<Frame>& frames, Side side,
                       std::vector<Part>& parts) {
  std::vector<std::size_t> shared;
  bool answers_elsewhere = false;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (parts[i].role != Role::other) continue;
    const auto& frame = frames[i];
    if (motor.on_shared_id(frame)) {
      shared.push_back(i);
      parts[i].side = side;
    } else if (motor.may_be_reply(frame)) {
      parts[i] = {Role::reply, side};
      answers_elsewhere = true;
    } else if (motor.has_command_id(frame)) {
      parts[i] = {Role::command, side};
    }
  }
  const bool any_reply =
      std::ranges::any_of(shared, [&](std::size_t i) { return motor.may_be_reply(frames[i]); });
  if (!answers_elsewhere && any_reply) return motor.share(frames, shared, parts);
  for (const auto i : shared) parts[i].role = Role::command;
  return Evidence::identifier;
}

}  // namespace

Roles find_roles(const std::vector<Frame>& frames, const CanConfig& config) {
  Roles out;
  out.parts.resize(frames.size());
  for (std::size_t i = 0; i < frames.size(); ++i)
    if (frames[i].is_error()) out.parts[i].role = Role::error;
  mark_doubled(frames, out.parts);
  for (std::size_t m = 0; m < static_cast<std::size_t>(config.motor_count); ++m) {
    const MotorFrames motor(config.motor[m], longest_reply_ns(config));
    out.evidence[m] = find_roles_of(motor, frames, static_cast<Side>(m), out.parts);
  }
  return out;
}

}  // namespace sandhopper::trace
