#pragma once
#include <cstdint>
#include <map>
#include <set>
#include <vector>

#include "drivers/can/can_config.hpp"
#include "tools/trial/trace/findings.hpp"
#include "tools/trial/trace/roles.hpp"
#include "tools/trial/trace/trace_file.hpp"

namespace sandhopper::trace {

// The dialect of each drive as the identifiers of a trace show it, whatever is configured.
struct DialectsSeen {
  std::map<int, std::uint64_t> status;           // frames 29xx, servo or v3, by drive
  std::map<int, std::uint64_t> mit_replies;      // standard frames that look like replies, by drive
  std::map<int, std::uint32_t> mit_reply_id;     // their identifier
  std::set<int> servo_commands, v3_commands;     // drives
  std::map<std::uint32_t, std::uint64_t> other;  // identifiers that belong to no configured motor, frames
};

// Frames of identifier X look like MIT replies of drive n if all of at least ten begin with byte n (1 to 7E),
// have 6 to 8 bytes, and those with 8 end with an error code.
DialectsSeen examine_dialects(const std::vector<Frame>& frames, const Roles& roles, const CanConfig& config);

// `replies`: of each motor, decoded.
Findings dialect_findings(const DialectsSeen& seen, const CanConfig& config,
                          const std::vector<std::uint64_t>& replies);

}  // namespace sandhopper::trace
