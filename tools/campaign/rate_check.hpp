#pragma once
#include "tools/campaign/check_channels.hpp"

namespace sandhopper {

// Compares each speed channel with the rate of its position, and a plate's acceleration with that of its
// speed: v = r dx/dt by least squares over spans of 1/20 of the rows, which suppresses the noise of the
// sensor. Reported (implausible) if both correlate and
// - r is beyond 0.2 to 5, or negative, or
// - r is that of two units (3.6, 2.54 …) or of a gear's two sides (2, 3) within 3 % and the correlation is
//   nearly 1,
// or if the speed is the rate of another channel instead: exchanged columns. The cures hold the corrected
// lines of [columns].
void check_rates(TrialRecording& recording, const RecordingPlaces& places);

}  // namespace sandhopper
