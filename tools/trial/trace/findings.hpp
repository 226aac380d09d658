#pragma once
#include <string>
#include <vector>

namespace sandhopper::trace {

// Something a trace contains besides decoded replies.
struct Finding {
  std::string kind;     // "clock_step", "missed_replies": a word for programs
  std::string text;     // with its numbers
  std::string cure{};   // empty where nothing need be done
  bool trusted = true;  // false: figures taken from this trace may be wrong
};

using Findings = std::vector<Finding>;

inline bool all_trusted(const Findings& findings) {
  for (const auto& finding : findings)
    if (!finding.trusted) return false;
  return true;
}

}  // namespace sandhopper::trace
