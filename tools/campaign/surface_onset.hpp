#pragma once
#include <span>

#include "tools/campaign/check_channels.hpp"

namespace sandhopper {

// Compares depth 0 of a press with the depth at which the bed begins to push. Notes the difference and the
// offset of foot_z_m that removes it if
// - the force rises for good while the depth is still negative: nothing touches a foot above the surface; or
// - the force grows at first with more than the cube of the depth. F ~ d^n has n = 1 for a plate (Bekker's n
//   is 0.3 to 1.7), 2 for a wedge, 3 for a cone, whose area grows with d^2; so no foot does that.
// A smaller difference than a foot that is 2 degrees out of level makes (one of its edges touches first) is
// no fault of the depth.
// Nothing is noted of a recording in which the force grows from its first row on: its foot was in the bed
// already, and the surface is not in it.
// Returns the surface's depth if it is noted, else 0.
double check_surface_onset(TrialRecording& recording, const Campaign& campaign, const CampaignTrial& trial,
                           const RecordingPlaces& places);

// True if the force grows in the rows before `first`, in which the foot seems to be in air, at half the rate
// of as many rows from `first` on, or faster.
bool is_loaded_at_start(std::span<const double> depth_m, std::span<const double> force_N, std::size_t first);

}  // namespace sandhopper
