#pragma once
#include <optional>
#include <vector>

#include "tools/trial/trace/trace_report.hpp"

namespace sandhopper::trace {

// Torque that a command asks for in the state of its reply, kp (p_des - p) + kd (v_des - v) + feed-forward,
// and the torque of that reply, both as the drive counts them.
struct TorquePair {
  double asked_Nm = 0.0;
  double reported_Nm = 0.0;
};

// Ratio of reported to asked torque. Its ends are the two regressions, of the reported on the asked torque
// and of the asked on the reported, widened by Student's t over ten parts of the trace. Noise and delay of
// either torque lower one regression and raise the other, so a sound drive stays between them.
struct TorqueRatio {
  double value = 1.0;
  double low = 1.0;
  double high = 1.0;
};

// Empty with too few pairs, if a torque does not vary, or if the two do not rise together.
std::optional<TorqueRatio> torque_ratio(const std::vector<TorquePair>& pairs, const CubeMarsConfig& motor);

// Findings for motors of the MIT dialect whose replies have another torque than their commands.
Findings torque_findings(const TraceReport& report, const std::vector<Frame>& frames, const Roles& roles,
                         const CanConfig& config);

}  // namespace sandhopper::trace
