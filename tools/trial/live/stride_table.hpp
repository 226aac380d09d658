#pragma once
#include "tools/trial/live/pane.hpp"
#include "tools/trial/live/trial_model.hpp"

namespace sandhopper {

// The last strides, at most `most`, with the stiffness of the joint fit and its 95 % interval.
void draw_strides(Pane& pane, const TrialModel& model, int most);

}  // namespace sandhopper
