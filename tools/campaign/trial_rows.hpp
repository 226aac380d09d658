#pragma once
#include <cstddef>
#include <vector>

#include "tools/campaign/check_channels.hpp"
#include "tools/campaign/trial_recording.hpp"

// The rows of a recording once its columns are known.
namespace sandhopper {

void keep_rows(TrialRecording& recording, RecordingPlaces& places, const std::vector<std::size_t>& keep);

// Rows of one instant become one: later cells fill what the earlier row left empty. With a selection the
// order has not been checked yet; a row that steps back is left out.
void join_equal_times(TrialRecording& recording, RecordingPlaces& places);

// Steps of more than five times the median step, said once with the largest.
void note_gaps(TrialRecording& recording, const RecordingPlaces& places);

}  // namespace sandhopper
