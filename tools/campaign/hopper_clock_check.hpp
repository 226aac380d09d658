#pragma once
#include "tools/campaign/campaign.hpp"
#include "tools/campaign/check_channels.hpp"

namespace sandhopper {

// Compares the length of a hopper's leg by its joints with the one by motion capture, body minus foot.
// Reported (implausible): heights that agree with the joints only later or earlier, by more than 1/20 of a
// stance, as for the load cell (hopper_force_check). Two signals are compared only if they move together.
void check_hopper_clock(TrialRecording& recording, const Campaign& campaign, const CampaignTrial& trial,
                        const RecordingPlaces& places);

}  // namespace sandhopper
