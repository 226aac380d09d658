#pragma once
#include "tools/trial/trace/trace_report.hpp"

namespace sandhopper::trace {

// Findings for motors whose replies give a temperature above `limit_C`, limits.motor_temperature_C of
// robot.toml, at which the robot itself raises a fault; a note for a drive that sends none.
Findings temperature_findings(const TraceReport& report, const CanConfig& config, double limit_C);

}  // namespace sandhopper::trace
