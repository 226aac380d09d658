#pragma once
#include "tools/trial/live/canvas.hpp"
#include "tools/trial/live/trial_model.hpp"

namespace sandhopper {

// The complete view of a trial for this screen size. From 60 x 20 characters nothing is cut off. Wide screens
// (from 120 columns) have plots and messages beside the numbers.
Canvas trial_screen(const TrialModel& model, ScreenSize size);

}  // namespace sandhopper
