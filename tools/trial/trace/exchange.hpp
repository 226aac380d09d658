#pragma once
#include <cstdint>
#include <vector>

#include "drivers/can/can_config.hpp"
#include "tools/trial/trace/findings.hpp"
#include "tools/trial/trace/roles.hpp"
#include "tools/trial/trace/trace_file.hpp"

namespace sandhopper::trace {

// Time between two replies of one motor.
struct Gap {
  std::int64_t length_ns = 0;
  std::int64_t begin_ns = 0;  // time of the reply before the gap
  std::uint64_t line = 0;     // line of the reply after the gap
};

// Result of comparing the commands to one motor with its replies.
struct Exchange {
  std::uint64_t commands = 0;
  std::uint64_t commands_twice = 0;  // echoes: the same command again before a reply could have come
  std::uint64_t set_zero = 0;        // commands that set the zero
  std::uint64_t replies = 0;
  std::uint64_t doubled = 0;      // copies of replies, which are left out
  std::uint64_t missed = 0;       // commands without a reply; for a drive that sends unasked, missing replies
                                  // according to its rate
  std::uint64_t most_missed = 0;  // largest number missed in a row
  std::uint64_t late = 0;         // replies that came later than the bus can delay one
  std::int64_t latest_ns = 0;     // longest time from command to reply
  std::uint64_t unasked = 0;      // replies without a command
  bool begins_with_reply = false;  // one reply before the first command: the recording began in between
  std::uint64_t malformed = 0;     // replies with an invalid length
  std::uint64_t ambiguous = 0;     // frames that may be commands or replies
  // Median time between commands, or the mean if that is 0; between replies if there are no commands.
  std::int64_t period_ns = 0;
  double worst_share = 1.0;  // smallest answered share of 50 commands in a row
  Gap longest_gap{};
};

// `frames` are in the order of their times, `roles` was found for them.
Exchange examine_exchange(const std::vector<Frame>& frames, const Roles& roles, Side side,
                          const CanConfig& config);

// Limits beyond which the robot itself would have raised a fault: limits.motor_reply_misses and
// supervision.motor_reply_share of robot.toml.
struct ReplyLimits {
  int misses = 3;
  double share = 0.6;
};
Findings exchange_findings(const Exchange& exchange, const CubeMarsConfig& motor, Evidence evidence,
                           const ReplyLimits& limits);

}  // namespace sandhopper::trace
