#pragma once
#include "tools/campaign/check_channels.hpp"

namespace sandhopper {

// Doubts a force on a pushed foot that in one row goes by ten times its next largest step while the foot goes
// on, in one of the ways in which no ground yields:
// - it changes its sign: a bed only pushes. A counter is full, or the sensor was turned;
// - it begins again at 0 and grows as before: the cell was tared under load;
// - it goes on at 10, 100 or 1000 times the force and its slope, or that part of them: the gain or the unit
//   changed.
// A crust that breaks leaves a smaller force of any size, or a slope of another kind, and stays silent.
void check_force_steps(TrialRecording& recording, const RecordingPlaces& places);

}  // namespace sandhopper
