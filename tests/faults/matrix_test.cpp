#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "tests/faults/setup.hpp"

namespace sandhopper::faults {
namespace {

TEST(FaultMatrix, EveryCellReachesItsStateInTimeAndStandsInTheLog) {
  const auto setup = shipped_setup();
  const auto cells = all_cells();
  EXPECT_GE(cells.size(), 150U);
  std::map<Fault, int> slowest;
  int unseen = 0;
  for (const auto& cell : cells) {
    const auto result = run_cell(cell, setup);
    EXPECT_EQ(result.problem, "") << cell.name() << " at " << name_of(cell.phase);
    unseen += cell.expected == Fault::none;
    EXPECT_EQ(result.message.find("; allowed: ") != std::string::npos, result.found != Fault::none)
        << cell.name() << ": " << result.message;
    if (cell.expected != Fault::none)
      slowest[cell.expected] = std::max(slowest[cell.expected], result.cycles);
  }
  std::printf("%zu cells, %d of them cannot be seen\n", cells.size(), unseen);
  for (const auto& [fault, n] : slowest)
    std::printf("  %-27s at most %3d cycles, allowed %3d\n", std::string(name_of(fault)).c_str(), n,
                entry_of(fault).cycles);
}

TEST(FaultMatrix, LostAndBadRepliesDriveErrorsAndTheEmergencyStopAreSeenWithinThreeCycles) {
  for (const auto fault : {Fault::emergency_stop, Fault::motor_reply_lost, Fault::drive_error,
                           Fault::motor_position_jump, Fault::motor_speed_limit, Fault::motor_reply_foreign})
    EXPECT_LE(entry_of(fault).cycles, 3) << name_of(fault);
}

TEST(FaultMatrix, EveryFaultHasACellAndEveryCellAFault) {
  std::set<Fault> covered;
  for (const auto& cell : all_cells()) covered.insert(cell.expected);
  for (const auto& entry : kFaults) EXPECT_TRUE(covered.contains(entry.fault)) << entry.name;
}

// Proves that every detector is needed: without it at least one cell must be wrong.
TEST(FaultMatrix, WithoutAnyOneDetectorTheMatrixFails) {
  auto setup = shipped_setup();
  const auto cells = all_cells();
  int silent = 0;
  for (const auto& entry : kFaults) {
    if (entry.fault == Fault::none) continue;
    setup.without = entry.fault;
    bool failed = false;
    for (const auto& cell : cells)
      if (!failed && cell.expected == entry.fault) failed = !run_cell(cell, setup).problem.empty();
    EXPECT_TRUE(failed) << "the detector of " << entry.name << " is not needed by any cell";
    silent += !failed;
  }
  std::printf("%zu detectors switched off in turn: the matrix failed %zu times\n", kFaultCount - 1,
              kFaultCount - 1 - static_cast<std::size_t>(silent));
}

}  // namespace
}  // namespace sandhopper::faults
