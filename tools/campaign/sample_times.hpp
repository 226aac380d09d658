#pragma once
#include <string>

#include "tools/campaign/check_channels.hpp"
#include "tools/campaign/trial_recording.hpp"

namespace sandhopper {

// 0.002 s -> "2 ms"
std::string duration(double s);

// A command and the torque that it asks for hold between their samples; what is measured does not.
bool holds_in_truth(const std::string& channel);

// Finds times with too few digits. Rows that share a time but differ in a channel are separate samples. If
// they are more than a tenth of all rows, the trial is unusable; with `spread_times` the rows are instead
// spread evenly (least squares of the times over the row number). Times whose steps are all multiples of a
// resolution above 15 % of the mean step get a note. Call it before rows of the same time are joined.
void check_times(TrialRecording& recording, const RecordingPlaces& places, bool spread_times);

// Finds values that are not samples. A value repeated over a fixed number of rows, while another channel
// changes in every row, gets a note with the true rate. The repeats are removed, but those of commands,
// torques and currents, which hold in truth. Zeros between single true samples are removed.
void check_held_samples(TrialRecording& recording, const RecordingPlaces& places);

}  // namespace sandhopper
