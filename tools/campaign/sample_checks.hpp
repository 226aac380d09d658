#pragma once
#include "tools/campaign/campaign.hpp"
#include "tools/campaign/check_channels.hpp"

namespace sandhopper {

// Everything that the samples of another program's recording tell against units, signs, columns and clocks.
// Rows of equal time must have been joined.
void check_samples(TrialRecording& recording, const Campaign& campaign, const CampaignTrial& trial,
                   const RecordingPlaces& places);

// The part of check_samples that compares the force on a foot with its depth.
void check_press(TrialRecording& recording, const Campaign& campaign, const CampaignTrial& trial,
                 const RecordingPlaces& places);

}  // namespace sandhopper
