#pragma once
#include "tools/campaign/campaign.hpp"
#include "tools/campaign/check_channels.hpp"

namespace sandhopper {

// Doubts the times of a falling body that gets faster within one row by more than a fall at 1.5 g (the limit
// of fall_check) and the noise of the height explain, and falls evenly before and after. Air, a liquid and
// the ground slow a body down; nothing in a fall pulls it. The frames after the row are farther apart than
// the times say, as of a camera with a varying frame rate whose mean was used. A rate that becomes faster
// looks like a body that is braked, and is not seen.
void check_fall_kink(TrialRecording& recording, const Campaign& campaign, const RecordingPlaces& places);

}  // namespace sandhopper
