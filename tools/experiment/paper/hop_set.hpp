#pragma once
#include <functional>
#include <vector>

#include "tools/experiment/paper/decomposition.hpp"
#include "tools/experiment/paper/estimation_error.hpp"
#include "tools/experiment/paper/stride_shape.hpp"

namespace sandhopper::paper {

// Results that are kept of one trial of the hop set.
struct HopResult {
  std::size_t cell = 0;  // index in hop_cells()
  bool complete = false;
  StrideShape shape{};
  EstimationErrors errors{};
  Decomposition truth{}, instruments{}, robot{};
  double quasi_static_r_squared = 0.0;  // r^2 of a line through force over estimated depth, penetrating
                                        // samples
  double observer_r_squared = 0.0;
  Validity validity = Validity::valid;  // of the observer's stiffness, as in the firmware
};

struct HopSetSetup {
  CycleConfig cycle{};
  WorldConfig world{};
  int seeds = 8;
  int trials_per_cell = 5;
  unsigned threads = 2;
  std::function<void(int done, int total)> progress{};
};

// Runs seeds x cells x trials, in that order, with the same beds and sensors as run_treatment_study.
std::vector<HopResult> run_hop_set(const HopSetSetup& setup, const ForceMap& map);

}  // namespace sandhopper::paper
