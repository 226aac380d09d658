#pragma once
#include <functional>
#include <vector>

#include "tools/experiment/paper/programme.hpp"

// Means and shares over the trials of the hop set.
namespace sandhopper::paper {

// Complete trials that `wanted` selects (all if it is empty).
std::vector<const HopResult*> complete_trials(const ProgrammeResults& results,
                                              const std::function<bool(const HopCell&)>& wanted = {});

// Estimation errors of all complete trials together.
EstimationErrors errors_of_all(const ProgrammeResults& results);

// Values of a feature in those trials that have it.
std::vector<double> over(const std::vector<const HopResult*>& trials,
                         const std::function<double(const HopResult&)>& feature);
double share_of(const std::vector<const HopResult*>& trials,
                const std::function<bool(const HopResult&)>& holds);

// Means over the complete trials of one touchdown speed.
struct SpeedDecomposition {
  double speed_mps;
  double line_N, map_N, inertial_N;  // rms residual of each description
  double correlation;

  double drop_percent() const { return 100.0 * (1.0 - inertial_N / map_N); }
};
std::vector<SpeedDecomposition> decomposition_by_speed(const ProgrammeResults& results,
                                                       Decomposition HopResult::*source);

struct SpeedErrors {
  double speed_mps;
  EstimationErrors errors;
};
std::vector<SpeedErrors> errors_by_speed(const ProgrammeResults& results);

}  // namespace sandhopper::paper
