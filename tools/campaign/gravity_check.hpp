#pragma once
#include "tools/campaign/check_channels.hpp"

namespace sandhopper {

// Doubts a foot's acceleration that holds gravity, as an accelerometer reads it: the channel is the foot's
// own acceleration, 0 at rest. The offset b of a recording of position z and acceleration a follows from
//   z(t) = z0 + v0 t - b t^2 / 2 + double integral of a
// by least squares. Nearer to 1 g than to 0, of either sign, it is gravity: no sensor has such an offset.
void check_gravity(TrialRecording& recording, const RecordingPlaces& places);

}  // namespace sandhopper
