#pragma once
#include "tools/campaign/campaign.hpp"
#include "tools/campaign/check_channels.hpp"

namespace sandhopper {

// Heights of a falling body that the logger wrote again where it had no new sample, in any number of rows:
// the body seems to stand still and then goes on the same way. No force in the air does that. Gets a note,
// and the repeats are emptied; so is a first value that may be as old, because the rows before it are not
// known. Not touched: a coarse height, whose steps beside the repeats are all of one or two sizes, and a rest
// that is longer than every hold. check_held_samples finds holds of equal length beside a faster channel.
void check_held_heights(TrialRecording& recording, const Campaign& campaign, const RecordingPlaces& places);

}  // namespace sandhopper
