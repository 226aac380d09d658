#pragma once
#include "tools/campaign/check_channels.hpp"

namespace sandhopper {

// True if forces go on after the last depth for longer than any two depths are apart.
bool forces_outlast_depths(const TrialRecording& recording);

// Notes a depth that stands in every row down to one, and in none below, where forces outlast it. The depth
// ended, or it is of a slower sensor whose samples stand below each other from the top, so that they are not
// in the rows of their times. True if it is noted.
bool note_early_end(TrialRecording& recording, const RecordingPlaces& places);

}  // namespace sandhopper
