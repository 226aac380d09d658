#pragma once
#include <string_view>
#include <vector>

#include "tools/campaign/trial_recording.hpp"

namespace sandhopper {

// Rows that have a position and an acceleration, with the acceleration integrated twice up to there. It is
// taken as linear between its samples, and as at rest before the first.
struct IntegratedTwice {
  std::vector<double> t_s, position_m, way_m;
};
IntegratedTwice integrated_twice(const TrialRecording& recording, std::string_view acceleration,
                                 std::string_view position);

}  // namespace sandhopper
