#pragma once
#include "tools/trial/live/pane.hpp"
#include "tools/trial/live/trial_model.hpp"

namespace sandhopper {

// Number of lines that the ground needs below the strides.
int ground_rows(const TrialModel& model, int columns);

// Shows the last strides, at most `most`, with the stiffness of the joint fit and its 95 % interval, and
// below them the known properties of the ground.
void draw_strides(Pane& pane, const TrialModel& model, int most);

}  // namespace sandhopper
