#pragma once
#include "tools/campaign/campaign.hpp"
#include "tools/campaign/check_channels.hpp"
#include "tools/campaign/trial_recording.hpp"

namespace sandhopper {

// Doubts a fall that no body makes: one that is even and much slower than gravity (a stretched time), one
// that air brakes with a drag coefficient that no body has (mass, area or density in another unit), and one
// from a height that is a hundred or a thousand times the recorded one. Speeds come from `height_m`.
void check_fall_limits(TrialRecording& recording, const Campaign& campaign, const CampaignTrial& trial,
                       const RecordingPlaces& places);

}  // namespace sandhopper
