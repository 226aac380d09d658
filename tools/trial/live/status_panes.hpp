#pragma once
#include <string>

#include "tools/trial/live/pane.hpp"
#include "tools/trial/live/trial_model.hpp"

// Numeric part of the view, from top to bottom. Each function uses the next lines of the pane.
namespace sandhopper {

struct Hint {
  std::string text;
  Style style = Style::plain;
};

// Next action for the operator. If the last key had no effect, the reason instead.
Hint hint(const TrialModel& model);

void draw_state(Pane& pane, const TrialModel& model);
void draw_leg_and_forces(Pane& pane, const TrialModel& model);
void draw_motors(Pane& pane, const TrialModel& model);
void draw_cycle(Pane& pane, const TrialModel& model);
void draw_latency(Pane& pane, const TrialModel& model);
void draw_sheet(Pane& pane, const TrialModel& model);
int fault_rows(const TrialModel& model, int columns);  // 0: no fault
void draw_fault(Pane& pane, const TrialModel& model);

// One bar per character; heights are proportional to the logarithm of the counts.
std::string log_histogram(const std::array<std::uint64_t, LatencyHistogram::kOctaves>& counts);

}  // namespace sandhopper
