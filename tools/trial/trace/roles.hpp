#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "drivers/can/can_config.hpp"
#include "tools/trial/trace/findings.hpp"
#include "tools/trial/trace/trace_file.hpp"

namespace sandhopper::trace {

// Role of a frame in the traffic between host and drives.
enum class Role : std::uint8_t {
  other,      // frame of another node
  error,      // error frame of the recording computer's controller
  command,    // command to a configured motor
  reply,      // reply of a configured motor
  ambiguous,  // on a motor's command identifier, and nothing shows whether it is a command or a reply
  doubled     // a second copy of the same frame, closer than two frames on one bus can be
};

struct Part {
  Role role = Role::other;
  Side side = Side::left;
};

// Method that separated a motor's replies from commands to it.
enum class Evidence : std::uint8_t {
  identifier,  // replies have their own identifiers
  direction,   // the trace marks the frames that were sent (candump -x)
  exchange,    // both on one identifier: a reply follows a command within less than half the commands' period
  none         // both on one identifier with even times: they cannot be separated
};

struct Roles {
  std::vector<Part> parts;  // one per frame
  std::array<Evidence, kMotorCount> evidence{};
};

// Finds commands and replies by examining both directions together; frames are in the order of their times. A
// drive of the MIT dialect may answer on identifier 0, on its master_id, or on the identifier of its
// commands. The first byte of an answer is the drive's number, but a command may begin with the same byte. So
// a frame on the command's identifier counts as an answer only if the drive answers on no other identifier
// and the frame follows a command. Servo and v3 have separate identifiers for each direction.
Roles find_roles(const std::vector<Frame>& frames, const CanConfig& config);

}  // namespace sandhopper::trace
