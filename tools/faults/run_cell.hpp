#pragma once
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "firmware/freeze/freeze_ring.hpp"
#include "tools/faults/cell.hpp"
#include "tools/plant/world_config.hpp"

namespace sandhopper::faults {

// Robot, world and options common to all cells of a run.
struct MatrixSetup {
  RobotConfig robot{};
  WorldConfig world{};
  std::filesystem::path folder;    // for the cells' logs; each log is removed after use
  std::optional<Fault> without{};  // detector to switch off; some cell must then fail
  std::uint64_t seed = 1;
  // Gets the cell's robot configuration and returns the ring that records its cycles. If set, each trial runs
  // on for the second after the fault. May be empty.
  std::function<FreezeRing*(const RobotConfig& robot)> freeze{};
};

// Result of a cell. Cycles are counts of 1 ms.
struct CellResult {
  Fault found = Fault::none;   // first fault that was raised
  int cycles = -1;             // from the first cycle that could show the fault to the cycle that raised it
  State state = State::idle;   // at the end of the trial
  Fault at_end = Fault::none;  // fault at the end of the trial; it may be a harsher one
  std::string torque;          // last command of the trial, in words
  bool logged = false;         // true: the log file holds the event
  double time_s = 0.0;         // duration of the trial
  std::string message;         // text of the fault found: measured and allowed value
  std::string problem;         // empty: the cell passed
};

// Runs one cell as a trial of its own: arms, releases and hops to the cell's phase, plants the fault, and
// judges the reaction.
CellResult run_cell(const Cell& cell, const MatrixSetup& setup);

}  // namespace sandhopper::faults
