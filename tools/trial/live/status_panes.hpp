#pragma once
#include <string>

#include "tools/trial/live/pane.hpp"
#include "tools/trial/live/trial_model.hpp"

// The numbers of the view, top to bottom. Each takes the next lines of the pane.
namespace sandhopper {

struct Hint {
  std::string text;
  Style style = Style::plain;
};

// What the operator does next; instead of it, why the last key did nothing.
Hint hint(const TrialModel& model);

void draw_state(Pane& pane, const TrialModel& model);
void draw_leg_and_forces(Pane& pane, const TrialModel& model);
void draw_motors(Pane& pane, const TrialModel& model);
void draw_cycle(Pane& pane, const TrialModel& model);
void draw_latency(Pane& pane, const TrialModel& model);
void draw_sheet(Pane& pane, const TrialModel& model);
int fault_rows(const TrialModel& model, int columns);  // 0: nothing is wrong
void draw_fault(Pane& pane, const TrialModel& model);

// Bars of one character each, from nothing to full, heights by the logarithm of the counts.
std::string log_histogram(const std::array<std::uint64_t, LatencyHistogram::kOctaves>& counts);

}  // namespace sandhopper
