#pragma once
#include "tools/trial/live/pane.hpp"
#include "tools/trial/live/trial_model.hpp"

namespace sandhopper {

// Leg length and bed force over time: the last seconds, and from the release on the whole hop. Two plots, one
// above the other.
void draw_history(Canvas& canvas, Pane::Area area, const TrialModel& model);

}  // namespace sandhopper
