#pragma once
#include "tools/campaign/check_channels.hpp"

namespace sandhopper {

// Compares depth 0 of a press with the depth at which the bed begins to push. Notes the difference and the
// offset of foot_z_m that removes it if
// - the force rises for good while the depth is still negative: nothing touches a foot above the surface; or
// - the force grows at first with more than the cube of the depth. F ~ d^n has n = 1 for a plate (Bekker's n
//   is 0.3 to 1.7), 2 for a wedge, 3 for a cone, whose area grows with d^2; so no foot does that.
// A smaller difference than a foot that is 2 degrees out of level makes (one of its edges touches first) is
// no fault of the depth.
// Returns the surface's depth if it is noted, else 0.
double check_surface_onset(TrialRecording& recording, const Campaign& campaign, const CampaignTrial& trial,
                           const RecordingPlaces& places);

}  // namespace sandhopper
