#pragma once
#include "tools/campaign/check_channels.hpp"

namespace sandhopper {

// Looks for the angle of an axis without a recorded torque that turns round within one row at full speed,
// twice or more at one place. Torque and gravity change a speed little by little, ten times less in the usual
// row.
// - At +-90 degrees, with the same speed before and after: the angle comes from an arcsine and is folded
// there.
//   The trial is lost.
// - Elsewhere, or more slowly than before: the axis hits an end stop, which the plant does not have. A note,
// with
//   the rows before the first blow.
void check_sharp_turns(TrialRecording& recording, const RecordingPlaces& places);

}  // namespace sandhopper
