#pragma once
#include <functional>
#include <string>
#include <vector>

#include "tests/transmit_guard/guard_bench.hpp"

namespace sandhopper::faults {

// What goes wrong at the robot meanwhile, so that the defect has its occasion.
enum class Occasion : std::uint8_t {
  hop,          // nothing: flight and stance
  stop_tapped,  // the e-stop is open for a moment
  stop_open,    // and stays open
  limp_fault,   // a drive reports an error
  damp_fault,   // a drive is hot
  hold_fault    // the foot is too high when armed
};

using Send = std::function<void(const can_frame& frame)>;

// A mistake in controller or driver, made by a stage of the test between the two, or between driver and
// guard.
struct Defect {
  std::string name;
  Dialect dialect = Dialect::mit;
  Occasion occasion = Occasion::hop;
  // What the board is told instead, once the occasion has come (hop: from the first torque on).
  std::function<void(const StepOutput& output, Command& command, Fault& told)> command{};
  // What the port is given instead of a frame, from the start: any number of frames.
  std::function<void(const can_frame& frame, const Send& send)> frames{};
  int begin_cycles = 1;  // how often the driver begins a cycle's frames in one cycle, and sends them
};

std::vector<Defect> all_defects();

}  // namespace sandhopper::faults
