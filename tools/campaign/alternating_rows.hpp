#pragma once
#include "tools/campaign/check_channels.hpp"

namespace sandhopper {

// Doubts a force whose rows take turns between two readings, as an amplifier writes that switches between two
// cells (the channels A and B of an HX711): the force goes up and down in turns for so many rows that noise
// does so in less than one of 1000 recordings, and its even rows grow by less than half as much as its odd
// ones, or the other way round. A hum at half the rate of the rows takes turns, too, but both halves grow
// alike.
void check_alternating_rows(TrialRecording& recording, const RecordingPlaces& places);

}  // namespace sandhopper
