#pragma once
#include "tools/campaign/check_channels.hpp"

namespace sandhopper {

// Doubts the unit of the force of a foot that is pushed in, if kilonewtons or millinewtons fit the believed
// stiffness better than newtons (limit: the geometric mean of two units), or if the largest force is less
// than the smoothest, lightest grains bear at the deepest depth. The trial is lost if newtons are only
// assumed; else it is noted, because the depth or the belief may be what is in another unit.
// `depth_ends_early`: the depth ends before the force, or stands in other rows than those of its times
// (note_early_end). Then the largest of all forces is looked at, and only that it is not too small.
void check_force_unit(TrialRecording& recording, const Campaign& campaign, const CampaignTrial& trial,
                      const RecordingPlaces& places, bool depth_ends_early = false);

}  // namespace sandhopper
