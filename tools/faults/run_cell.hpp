#pragma once
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "firmware/freeze/freeze_ring.hpp"
#include "tools/faults/cell.hpp"
#include "tools/plant/world_config.hpp"

namespace sandhopper::faults {

struct MatrixSetup {
  RobotConfig robot{};
  WorldConfig world{};
  std::filesystem::path folder;    // for the cells' logs; each is removed again
  std::optional<Fault> without{};  // this detector switched off: some cell must fail
  std::uint64_t seed = 1;
  // Given the robot's file of the cell: the ring that its cycles go to, and the trial then runs on for the
  // second after the fault. May be empty.
  std::function<FreezeRing*(const RobotConfig& robot)> freeze{};
};

struct CellResult {
  Fault found = Fault::none;   // the first one
  int cycles = -1;             // from the first cycle that could show it
  State state = State::idle;   // some cycles later
  Fault at_end = Fault::none;  // a harsher one may have followed
  std::string torque;          // what the drives were told after the reaction
  bool logged = false;         // the event stands in the log, read back from the file
  double time_s = 0.0;         // of the trial
  std::string message;         // of the fault found: what was seen and what is allowed
  std::string problem;         // empty: as it must be
};

// A trial of its own: arms, releases and hops to the cell's phase, breaks the device, and looks at what the
// robot does.
CellResult run_cell(const Cell& cell, const MatrixSetup& setup);

}  // namespace sandhopper::faults
