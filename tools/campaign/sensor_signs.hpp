#pragma once
#include "tools/campaign/check_channels.hpp"
#include "tools/campaign/trial_recording.hpp"

namespace sandhopper {

// Check signs and units from the physics at rest (check_signs) and under load (check_push_signs):
//   Specific force at rest is +g. 1 means g taken as m/s^2, -g an axis that points downward.
//   A bed pushes harder the deeper the foot is. If the largest forces are negative, or belong to the highest
//   positions, force or depth has the opposite sign.
// A finding makes the trial unusable, except if the mapping of the channel states both `unit` and `scale`:
// then it is a note.
void check_signs(TrialRecording& recording, const Campaign& campaign, const CampaignTrial& trial,
                 const RecordingPlaces& places);
void check_push_signs(TrialRecording& recording, const Campaign& campaign, const CampaignTrial& trial,
                      const RecordingPlaces& places);

}  // namespace sandhopper
