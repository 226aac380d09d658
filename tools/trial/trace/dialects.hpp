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

// Dialect of each drive as the identifiers of a trace show it, independent of the configuration.
struct DialectsSeen {
  std::map<int, std::uint64_t> status;           // number of status frames 29xx (servo or v3) per drive
  std::map<int, std::uint64_t> mit_replies;      // number of standard frames that look like replies, per
                                                 // drive
  std::map<int, std::uint32_t> mit_reply_id;     // identifier of these frames
  std::set<int> servo_commands, v3_commands;     // drives that got such commands
  std::map<std::uint32_t, std::uint64_t> other;  // identifiers that belong to no configured motor, and their
                                                 // number of frames
};

// Frames with identifier X look like MIT replies of drive n if there are at least ten, all begin with byte n
// (1 to 7E) and have 6 to 8 bytes, and those with 8 bytes end with an error code.
DialectsSeen examine_dialects(const std::vector<Frame>& frames, const Roles& roles, const CanConfig& config);

// `replies`: number of decoded replies of each motor.
Findings dialect_findings(const DialectsSeen& seen, const CanConfig& config,
                          const std::vector<std::uint64_t>& replies);

}  // namespace sandhopper::trace
