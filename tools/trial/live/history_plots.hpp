#pragma once
#include "tools/trial/live/pane.hpp"
#include "tools/trial/live/trial_model.hpp"

namespace sandhopper {

// Plots leg length and bed force over time: before the release the last seconds, afterwards the whole hop.
// Two plots, one above the other.
void draw_history(Canvas& canvas, Pane::Area area, const TrialModel& model);

}  // namespace sandhopper
