#pragma once
#include "tools/campaign/check_channels.hpp"

namespace sandhopper {

// Doubts the depth of a part of a file (select from_line or from_s) that begins with a force too large for
// its depth: the zero of the depth was set while the foot was in the bed. F ~ d^n has n = 0.3 or more for
// every foot (Bekker), so no force at a depth d exceeds (d / deepest)^0.3 of the largest one. For a whole
// file it is a note, because no row before shows the true zero.
void check_begins_in_bed(TrialRecording& recording, const CampaignTrial& trial,
                         const RecordingPlaces& places);

}  // namespace sandhopper
