#pragma once
#include <vector>

#include "tools/experiment/recorded_stride.hpp"
#include "tools/terrain/hop_frames.hpp"

namespace sandhopper {

// Configuration of the cycle for the robot as the trial's belief describes it.
CycleConfig cycle_config_for(const CampaignTrial& trial);

// Runs a recorded hop through the firmware's own estimators, stride by stride. The first stride begins at the
// release. True values are unknown (NaN). Phases are those recorded or, if there are none, those from the
// firmware's rules.
std::vector<RecordedStride> replay_hop(const HopFrames& hop, const CycleConfig& cycle, const Leg& leg);

}  // namespace sandhopper
