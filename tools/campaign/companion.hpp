#pragma once
#include "tools/campaign/trial_recording.hpp"

namespace sandhopper {

// Puts another recording on the same clock into this one: rows of both in the order of time, NaN where a
// channel has no sample, nothing from before its first or after its last row. A channel that both have is
// this one's. What is wrong with the other comes along; where it cannot be used at all this one stays as it
// is and says so.
void join_companion(TrialRecording& recording, TrialRecording other);

}  // namespace sandhopper
