#pragma once
#include <optional>
#include <vector>

#include "tools/trial/trace/trace_report.hpp"

namespace sandhopper::trace {

// Ratio of the speed v that a drive reports to the change dp of the position it reports, from the steps dt
// between its replies:
//   value = sum(v^2 dt) / sum(v dp), v the mean of the two replies.
// Unlike a regression on v dt it has no bias from times that an adapter delays, and none from a low-pass in
// the drive's speed. `hop calibrate encoders` finds the same ratio from a leg that is moved by hand.
struct SpeedRatio {
  double value = 1.0;  // 1 if speed and position have the configured ranges
  double ci95 = 0.0;   // half-width: Student's t over ten parts of the trace, and the share of noise in v
};

// Empty if the motor moves too little, or if noise of the speed hides the motion.
std::optional<SpeedRatio> speed_ratio(const std::vector<TimedReading>& decoded, Side side,
                                      const CubeMarsConfig& motor);

// Findings for motors whose speed does not fit the change of their position. A motor whose zero is set within
// the trace is not compared.
Findings speed_findings(const TraceReport& report, const CanConfig& config);

}  // namespace sandhopper::trace
