#pragma once
#include <cstdint>
#include <vector>

#include "tools/experiment/recorded_stride.hpp"
#include "tools/experiment/treatments.hpp"

namespace sandhopper::paper {

inline constexpr double kCycle_s = 1e-3;

// One cycle, from the release to shortly after liftoff. The estimate's forces belong to the instant of the
// motors' reply, which is the previous row.
struct HopRow {
  double time_s;  // since the release
  State state;
  Estimate estimate;
  PlantTruth truth;  // at the cycle's time
  TofSample tof;
  LoadCellSample load_cell;
  double mean_force_N;     // true mean over the millisecond that ends here
  double mean_accel_mps2;  // true mean acceleration of the foot over the same time
};

// One hop with the firmware's own controller on the simulated robot.
struct HopTrial {
  HopCell cell{};
  RecordedStride stride;  // the same cycles for re-evaluation, from release to liftoff
  std::vector<HopRow> rows;
  bool complete = false;
};

HopTrial run_hop(const CycleConfig& cycle, const WorldConfig& world, const HopCell& cell,
                 const TrialSetup& setup);

// Rows of physical contact, of the switch from compression to extension, and of liftoff; rows.size() if it
// did not happen.
struct StanceRows {
  std::size_t contact, change, liftoff;
};
StanceRows stance_rows(const HopTrial& trial);

}  // namespace sandhopper::paper
