#pragma once
#include <cstdint>
#include <vector>

#include "drivers/can/can_config.hpp"
#include "tools/trial/trace/findings.hpp"
#include "tools/trial/trace/roles.hpp"
#include "tools/trial/trace/trace_file.hpp"

namespace sandhopper::trace {

// A time between two replies of one motor.
struct Gap {
  std::int64_t length_ns = 0;
  std::int64_t begin_ns = 0;  // time of the reply before it
  std::uint64_t line = 0;     // of the reply after it
};

// Commands to one motor held against its replies.
struct Exchange {
  std::uint64_t commands = 0;
  std::uint64_t commands_twice = 0;  // the same command again before a reply could have come: its echo
  std::uint64_t set_zero = 0;        // of the commands
  std::uint64_t replies = 0;
  std::uint64_t doubled = 0;  // copies of replies, left out
  std::uint64_t missed = 0;   // commands without a reply; replies of a drive that speaks unasked, by its rate
  std::uint64_t most_missed = 0;  // in a row
  std::uint64_t late = 0;         // replies that came later than the bus can delay one
  std::int64_t latest_ns = 0;     // the longest time from command to reply
  std::uint64_t unasked = 0;      // replies without a command
  std::uint64_t malformed = 0;    // with a length that no reply has
  std::uint64_t ambiguous = 0;    // frames that may be commands or replies
  std::int64_t period_ns = 0;     // median time between commands, or between replies if there are no commands
  double worst_share = 1.0;       // smallest answered share of 50 commands in a row
  Gap longest_gap{};
};

// Frames in the order of their times, with the roles found for them.
Exchange examine_exchange(const std::vector<Frame>& frames, const Roles& roles, Side side,
                          const CanConfig& config);

// Events that the robot would itself have called a fault in a trial, limits.motor_reply_misses and
// supervision.motor_reply_share of robot.toml.
struct ReplyLimits {
  int misses = 3;
  double share = 0.6;
};
Findings exchange_findings(const Exchange& exchange, const CubeMarsConfig& motor, Evidence evidence,
                           const ReplyLimits& limits);

}  // namespace sandhopper::trace
