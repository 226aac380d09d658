#pragma once
#include "tools/campaign/campaign.hpp"
#include "tools/campaign/check_channels.hpp"
#include "tools/campaign/trial_recording.hpp"

namespace sandhopper {

// Compares the acceleration of a falling body with its height: h'' = f - g for a specific force f. Reports an
// acceleration from which gravity was taken out (h'' = a), and one that counts downward, if the height then
// fits ten times better. Returns true if it reports one.
bool check_fall_acceleration(TrialRecording& recording, const Campaign& campaign, const CampaignTrial& trial,
                             const RecordingPlaces& places);

}  // namespace sandhopper
