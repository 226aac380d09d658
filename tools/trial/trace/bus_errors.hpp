#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "tools/trial/trace/findings.hpp"
#include "tools/trial/trace/trace_file.hpp"

namespace sandhopper::trace {

struct BusErrors {
  std::uint64_t frames = 0;
  std::map<std::string, std::uint64_t> kinds;  // kind, such as "bus-off", and number of frames that report it
  bool bus_off = false;
  bool frames_lost = false;  // by the controller: its buffers overflowed, or it stopped sending
  int transmit_errors = 0;   // largest error counters reported
  int receive_errors = 0;
};

// Counts error frames by kind (linux/can/error.h).
BusErrors count_bus_errors(const std::vector<Frame>& frames);

Findings bus_error_findings(const BusErrors& errors);

}  // namespace sandhopper::trace
