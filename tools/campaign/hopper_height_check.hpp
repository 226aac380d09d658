#pragma once
#include "tools/campaign/campaign.hpp"
#include "tools/campaign/check_channels.hpp"

namespace sandhopper {

// Heights of a hopper against its other channels. Reported (implausible):
// - the body's height (motion capture, else the height sensor) moves by another factor than the body's
//   accelerometer integrated twice gives, in windows of 1/5 of the rows: another time scale or unit;
// - the foot is farther than its radius above or below the surface, mocap_foot_z_m = 0, when the load cell
//   first carries load: another zero of the height.
void check_hopper_heights(TrialRecording& recording, const Campaign& campaign, const CampaignTrial& trial,
                          const RecordingPlaces& places);

}  // namespace sandhopper
