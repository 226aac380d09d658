#pragma once
#include "tools/campaign/check_channels.hpp"

namespace sandhopper {

// Doubts the force of a gauge that holds its peak: it never falls from one row to the next, and it stays at
// its largest value while the foot comes up again by half of the deepest depth or more. A bed lets go, and a
// cell that is full falls back from its limit with the bed. True if it is found.
bool check_peak_hold(TrialRecording& recording, const CampaignTrial& trial, const RecordingPlaces& places);

}  // namespace sandhopper
