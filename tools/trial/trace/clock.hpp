#pragma once
#include <cstdint>
#include <vector>

#include "tools/trial/trace/findings.hpp"
#include "tools/trial/trace/trace_file.hpp"

namespace sandhopper::trace {

// A place at which the times of a trace jump.
struct ClockEvent {
  std::uint64_t line = 0;      // first line after it
  std::int64_t time_ns = 0;    // time before it
  std::int64_t change_ns = 0;  // change of the clock; negative: set back
};

struct ClockReport {
  std::vector<ClockEvent> steps_back;
  std::vector<ClockEvent> pauses;  // no frame at all: the recording was paused or the clock was set forward
  std::uint64_t swapped = 0;       // frames written after a later frame of the same batch
  bool differences = false;        // each time is the difference to the previous frame: candump -td
  std::int64_t resolution_ns = 1;  // 1, 1 000, …: every time is a multiple of it
};

// Examines only the times, in the order of the file. A frame counts as swapped if it lies up to one
// millisecond (a batch of the adapter) before its predecessor and its successors do not. Any other backward
// time is a step of the clock. A gap of more than `pause_ns` in all traffic is a pause.
ClockReport examine_clock(const std::vector<Frame>& frames, std::int64_t pause_ns);

// Sorts swapped frames by time. The order across a step of the clock stays as in the file.
void put_in_order(std::vector<Frame>& frames, const ClockReport& report);

// `period_ns` is the median time between commands to one motor.
Findings clock_findings(const ClockReport& report, const Trace& trace, std::int64_t period_ns);

}  // namespace sandhopper::trace
