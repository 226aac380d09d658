#pragma once
#include "tools/campaign/campaign.hpp"
#include "tools/campaign/check_channels.hpp"

namespace sandhopper {

// Compares the channels of one hop with each other. Reported (implausible):
// - the body below the foot (means of motion capture): exchanged columns;
// - a leg whose length by the joints, L(phi) + foot height, goes against the measured one (body minus foot,
// or the
//   body in stance): the angles count from the horizontal or from straight up, or in another unit; or they
//   are negative throughout;
// - currents that lengthen the leg are positive in stance, where they must carry the robot: other sign.
// Stance: `phase` above 0. Without it the last two are not looked at.
void check_hopper(TrialRecording& recording, const Campaign& campaign, const CampaignTrial& trial,
                  const RecordingPlaces& places);

}  // namespace sandhopper
