#pragma once
#include "tools/campaign/check_channels.hpp"
#include "tools/campaign/trial_recording.hpp"

namespace sandhopper {

// Signs and units that show where a rig rests or pushes:
//   a specific force at rest is +g (accelerometers): 1 is g taken for m/s^2, -g an axis that points downward;
//   a bed pushes a foot up the harder the deeper it stands: where the largest forces are negative, or belong
//   to the highest positions, force or depth is counted the other way.
// Adds what rules the trial out, or a note where `unit` and `scale` of the channel are both written down.
void check_signs(TrialRecording& recording, const Campaign& campaign, const CampaignTrial& trial,
                 const RecordingPlaces& places);

}  // namespace sandhopper
