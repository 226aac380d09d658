#pragma once
#include "tools/campaign/check_channels.hpp"

namespace sandhopper {

// Leaves out rows at the beginning whose clock was not set yet, more than three years before the next row,
// and rows at the end in which every channel repeats the row before, although each used to change from row to
// row: the logger or a spreadsheet filled them in. The clock may go on in them.
void drop_untrue_rows(TrialRecording& recording, RecordingPlaces& places);

}  // namespace sandhopper
