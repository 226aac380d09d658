#pragma once
#include "tools/campaign/check_channels.hpp"

namespace sandhopper {

// Samples that were put onto a finer grid by straight lines: the second differences of a channel are zero
// within its digits, but for knots at even distances. Gets a note with the true rate, and the rows between
// the knots are emptied. Not touched: a constant speed (no knots), a motion at one speed (all knots bend
// by the same amount), held values, commands, torques and currents. Interpolation by a smooth curve (spline,
// low pass) leaves no such trace and is not seen.
void check_interpolated(TrialRecording& recording, const RecordingPlaces& places);

// The last decimal digit with which a column was written, in the channel's unit. Empty cells (NaN) have none.
double written_digit(const std::vector<double>& values, const UsedColumn* column);

}  // namespace sandhopper
