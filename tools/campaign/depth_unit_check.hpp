#pragma once
#include "tools/campaign/check_channels.hpp"

namespace sandhopper {

// A depth whose unit nobody states, taken as metres. In doubt if the foot goes deeper than 100 of its
// diameters (the most slender penetrometers), if the bed resists less than grains can, or if the believed
// stiffness fits better with centimetres or millimetres.
void check_depth_unit(TrialRecording& recording, const Campaign& campaign, const CampaignTrial& trial,
                      const RecordingPlaces& places);

}  // namespace sandhopper
