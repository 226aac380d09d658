#pragma once
#include <string>
#include <vector>

namespace sandhopper::trace {

// A property of a trace besides the decoded replies.
struct Finding {
  std::string kind;     // identifier for programs: "clock_step", "missed_replies"
  std::string text;     // text with the numbers
  std::string cure{};   // empty if nothing must be done
  bool trusted = true;  // false: numbers derived from this trace may be wrong
};

using Findings = std::vector<Finding>;

inline bool all_trusted(const Findings& findings) {
  for (const auto& finding : findings)
    if (!finding.trusted) return false;
  return true;
}

}  // namespace sandhopper::trace
