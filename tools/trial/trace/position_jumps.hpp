#pragma once
#include "tools/trial/trace/trace_report.hpp"

namespace sandhopper::trace {

// Jumps of a position: steps between two replies of more than kFastest v T + kTravelSteps of the position, v
// the fastest speed that the motor reports in this trace (its velocity range, if it reports none), T the time
// between the replies, at least kLongestStep mean periods, because adapters deliver late.
// A motor with jumps in more than a tenth of its steps whose position is smooth with the two bytes exchanged
// has the other order of bytes. A motor whose zero is set within the trace is not looked at.
Findings position_jump_findings(const TraceReport& report, const CanConfig& config);

// True if only the exchanged bytes of the position (MIT dialect) give a smooth motion.
bool has_exchanged_bytes(const std::vector<TimedReading>& decoded, Side side, const CubeMarsConfig& motor);

}  // namespace sandhopper::trace
