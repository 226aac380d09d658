#pragma once
#include "tools/campaign/campaign.hpp"
#include "tools/campaign/check_channels.hpp"
#include "tools/campaign/trial_recording.hpp"

namespace sandhopper {

// Finds a value that a sensor writes where it has no sample, such as 8190 of a ranging sensor or 0 of a
// camera: a position that jumps to one and the same value again and again, and back to where it was. The
// largest steps of the signal, three or more, are all to or from this value; of random steps this would be
// true in one recording of 100,000 at most. A zero of an axis is only noted, because the diagnosis names that
// fault. Returns true if the trial is lost.
bool check_repeated_codes(TrialRecording& recording, const Campaign& campaign, const RecordingPlaces& places);

}  // namespace sandhopper
