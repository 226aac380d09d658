#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "drivers/can/can_config.hpp"
#include "tools/trial/trace/findings.hpp"
#include "tools/trial/trace/trace_file.hpp"

namespace sandhopper::trace {

// The part a frame plays between host and drives.
enum class Role : std::uint8_t {
  other,      // of another node
  error,      // of the recording computer's controller
  command,    // to a configured motor
  reply,      // of a configured motor
  ambiguous,  // on a motor's command identifier, and nothing says which of the two
  doubled     // the same frame a second time, closer than two frames of one bus can be
};

struct Part {
  Role role = Role::other;
  Side side = Side::left;
};

// The way in which a motor's replies were told from commands to it.
enum class Evidence : std::uint8_t {
  identifier,  // they have identifiers of their own
  direction,   // the trace says which frames were sent (candump -x)
  exchange,    // both on one identifier: a reply follows a command before half the commands' period is over
  none         // both on one identifier, and the times are even: they cannot be told apart
};

struct Roles {
  std::vector<Part> parts;  // one a frame
  std::array<Evidence, kMotorCount> evidence{};
};

// Finds commands and replies by looking at both directions together, frames in the order of their times.
// A drive of the MIT dialect may answer on identifier 0, its master_id, or the identifier of its commands;
// the first byte of an answer is the drive's number, and may be that of a command, too. So a
// frame on the command's identifier is an answer only if the drive answers on no other identifier and the
// frame follows a command. Servo and v3 have identifiers of their own for each direction.
Roles find_roles(const std::vector<Frame>& frames, const CanConfig& config);

}  // namespace sandhopper::trace
