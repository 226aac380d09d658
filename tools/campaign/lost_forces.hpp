#pragma once
#include <cstddef>
#include <vector>

#include "tools/campaign/check_channels.hpp"
#include "tools/campaign/trial_recording.hpp"

namespace sandhopper {

// Rows of a force on a pushed foot that hold no measurement.
struct LostForce {
  std::size_t first_row, last_row;
  bool is_zero;  // 0 was written; else the sample before it was repeated
};

// A bed's force follows the depth and a cell shows noise. Two things are therefore no measurement: zeros that
// the force jumps to and comes back from, and one value that stands still while the foot moves on, if equal
// samples are too rare elsewhere to be chance and the force jumps at its end. Nor is a value below depth 0
// that stands for all forces below a threshold (force_threshold). In the order of the rows.
std::vector<LostForce> lost_forces(const TrialRecording& recording);

// Notes them. Nothing is taken out: a diagnosis finds the fault of the logger itself.
void check_lost_forces(TrialRecording& recording, const RecordingPlaces& places);

// Empties these rows of the force, for a verb that must not use them.
void leave_out_lost_forces(TrialRecording& recording);

}  // namespace sandhopper
