#pragma once
#include <functional>
#include <string>
#include <vector>

#include "tests/transmit_guard/guard_bench.hpp"

namespace sandhopper::faults {

// Event at the robot during which the defect shows.
enum class Occasion : std::uint8_t {
  hop,          // no event: flight and stance
  stop_tapped,  // the e-stop opens for a moment
  stop_open,    // the e-stop stays open
  limp_fault,   // a drive reports an error
  damp_fault,   // a drive is hot
  hold_fault    // the foot is too high when the robot is armed
};

using Send = std::function<void(const can_frame& frame)>;

// A defect of controller or driver, planted between the two, or between driver and guard.
struct Defect {
  std::string name;
  Dialect dialect = Dialect::mit;
  Occasion occasion = Occasion::hop;
  // Replaces the command and the fault that the board gets, once the occasion has come (hop: from the first
  // torque on).
  std::function<void(const StepOutput& output, Command& command, Fault& told)> command{};
  // Replaces each frame by any number of frames, from the start.
  std::function<void(const can_frame& frame, const Send& send)> frames{};
  int begin_cycles = 1;  // number of times that the driver begins and sends a cycle's frames in one cycle
};

std::vector<Defect> all_defects();

}  // namespace sandhopper::faults
