#pragma once
#include <cstdint>
#include <vector>

#include "tools/trial/trace/findings.hpp"
#include "tools/trial/trace/trace_file.hpp"

namespace sandhopper::trace {

// A place at which the times of a trace do not go on evenly.
struct ClockEvent {
  std::uint64_t line = 0;      // the first one after it
  std::int64_t time_ns = 0;    // the time before it
  std::int64_t change_ns = 0;  // negative: set back
};

struct ClockReport {
  std::vector<ClockEvent> steps_back;
  std::vector<ClockEvent> pauses;  // no frame at all: recording paused, or clock set forward
  std::uint64_t swapped = 0;       // frames written after a later one of the same batch
  bool differences = false;        // each time is the time since the frame before: candump -td
  std::int64_t resolution_ns = 1;  // 1, 1 000, … : every time is a multiple of it
};

// Looks at the times alone, in the order of the file. A frame that lies up to one millisecond (a batch of the
// adapter) before its predecessor, and whose successors do not, is swapped; any other backward time is a step
// of the clock. A gap of more than `pause_ns` in all traffic is a pause.
ClockReport examine_clock(const std::vector<Frame>& frames, std::int64_t pause_ns);

// Moves swapped frames to their place. The order across a step of the clock stays as in the file.
void put_in_order(std::vector<Frame>& frames, const ClockReport& report);

// `period_ns`: median time between commands to one motor.
Findings clock_findings(const ClockReport& report, const Trace& trace, std::int64_t period_ns);

}  // namespace sandhopper::trace
