#pragma once
#include "tools/trial/trace/trace_report.hpp"

namespace sandhopper::trace {

// Findings for frames that look like those of a configured motor but stand under another kind of identifier:
// as CAN FD frames, as extended identifiers of the same number, or as replies on another motor's master_id.
Findings misplaced_findings(const TraceReport& report, const Trace& trace, const CanConfig& config);

}  // namespace sandhopper::trace
