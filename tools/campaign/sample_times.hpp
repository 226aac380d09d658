#pragma once
#include "tools/campaign/check_channels.hpp"
#include "tools/campaign/trial_recording.hpp"

namespace sandhopper {

// Times written with too few digits. Rows that share a time and hold different values of one channel are rows
// of their own: where they are more than a tenth, the trial is left out, or, with `spread_times`, the rows
// are spread evenly over the recording (least squares of the times over the number of the row). Steps that
// are all multiples of a resolution of more than 15 % of the mean step are noted. Call it before rows of one
// time are joined.
void check_times(TrialRecording& recording, const RecordingPlaces& places, bool spread_times);

// Samples that are none: a value repeated over a fixed number of rows while another channel changes with
// every row is noted with the rate that remains; zeros between single true samples become no samples.
void check_held_samples(TrialRecording& recording, const RecordingPlaces& places);

}  // namespace sandhopper
