#pragma once
#include "tools/trial/live/canvas.hpp"
#include "tools/trial/live/trial_model.hpp"

namespace sandhopper {

// The whole view of a trial at this size. From 60 x 20 on nothing is cut; wide screens (from 120 columns)
// have plots and messages beside the numbers.
Canvas trial_screen(const TrialModel& model, ScreenSize size);

}  // namespace sandhopper
