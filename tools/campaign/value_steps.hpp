#pragma once
#include "tools/campaign/check_channels.hpp"

namespace sandhopper {

// Looks at the steps between the values of a channel. A position that once goes in one row by ten times its
// next largest step and goes on from there is in doubt: its zero was set, or recordings follow each other. An
// angle is in doubt if it does so beside the change of its steps: the encoder slipped. A
// channel that takes no more than ten values in a hundred rows gets a note: too few digits were written.
// A speed that jumps again and again by the same amount while it goes on is in doubt: its counter is full.
void check_value_steps(TrialRecording& recording, const RecordingPlaces& places);

}  // namespace sandhopper
