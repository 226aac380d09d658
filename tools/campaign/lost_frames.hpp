#pragma once
#include "tools/campaign/check_channels.hpp"

namespace sandhopper {

// Frames that a camera or a logger lost, in a recording whose time was made from the row number. At such a
// row a position moves by two, three, ... of the steps on both sides of it, and does not come back. Three
// such rows or more put the time in doubt. True times, and times that only jitter, are not concerned: there a
// step that is too long is followed by one that is too short, or the time shows the gap. Nor is a recorder
// that reads the samples in its own time: it reads as many of them twice as it skips.
void check_lost_frames(TrialRecording& recording, const RecordingPlaces& places);

}  // namespace sandhopper
