#pragma once
#include "tools/campaign/campaign.hpp"
#include "tools/campaign/check_channels.hpp"

namespace sandhopper {

// An intruder that goes down evenly (its height is a straight line in time over 10 % to 90 % of its way,
// share of the variance 0.99) does so at the set-up's `impact_speed_mps`. Reported (implausible) if the two
// differ by more than a factor of 5, or by the ratio of two units of length or time within 3 %.
void check_press_speed(TrialRecording& recording, const Campaign& campaign, const CampaignTrial& trial,
                       const RecordingPlaces& places);

}  // namespace sandhopper
