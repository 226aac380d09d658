#pragma once
#include "tools/campaign/campaign.hpp"
#include "tools/campaign/check_channels.hpp"
#include "tools/campaign/trial_recording.hpp"

namespace sandhopper {

// What no falling body does, whatever it is: fall evenly and much slower than gravity (a stretched time), be
// braked by air with a drag coefficient that no body has (mass, area or density in another unit), or fall
// from a height that is a hundred or a thousand times the recorded one. Speeds come from `height_m`.
void check_fall_limits(TrialRecording& recording, const Campaign& campaign, const CampaignTrial& trial,
                       const RecordingPlaces& places);

}  // namespace sandhopper
