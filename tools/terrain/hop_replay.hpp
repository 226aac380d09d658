#pragma once
#include <vector>

#include "tools/experiment/recorded_stride.hpp"
#include "tools/terrain/hop_frames.hpp"

namespace sandhopper {

// The cycle's configuration for a robot that is believed to be so.
CycleConfig cycle_config_for(const CampaignTrial& trial);

// A recorded hop run through the firmware's own estimators, stride by stride. The first begins at the
// release; what is true is not known (NaN). Phases are the recorded ones or, where there are none, those that
// the firmware's rules give.
std::vector<RecordedStride> replay_hop(const HopFrames& hop, const CycleConfig& cycle, const Leg& leg);

}  // namespace sandhopper
