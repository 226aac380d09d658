#pragma once
#include "tools/trial/live/pane.hpp"
#include "tools/trial/live/trial_model.hpp"

namespace sandhopper {

// Lines that the ground takes below the strides.
int ground_rows(const TrialModel& model, int columns);

// The last strides, at most `most`, with the stiffness of the joint fit and its 95 % interval; below them
// what is known of the ground.
void draw_strides(Pane& pane, const TrialModel& model, int most);

}  // namespace sandhopper
