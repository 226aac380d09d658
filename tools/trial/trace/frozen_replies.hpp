#pragma once
#include "tools/trial/trace/trace_report.hpp"

namespace sandhopper::trace {

// Replies that stand still while they report a speed. In a run of replies with one position the reported
// speed amounts to a travel, the integral of v dt. Reported:
// - equal replies (position, speed and current) whose travel exceeds kTravelSteps of the position: old
//   readings, sent again by the drive or its adapter;
// - one position with different speeds, whose travel is also more than a speed that is late by kLongestStep
//   replies would give after a sudden stop, and is not noise.
// Speeds that the resolution does not tell from rest (least_speed_radps) do not count. A speed field that is
// the same in all replies while the position moves is reported, too.
Findings frozen_findings(const TraceReport& report, const CanConfig& config);

// True if the speed field of this motor does not tell its motion: the same in all replies and near zero,
// while the position travels.
bool has_no_speed(const std::vector<TimedReading>& decoded, Side side, const CubeMarsConfig& motor);

}  // namespace sandhopper::trace
