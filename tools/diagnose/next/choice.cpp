#include "tools/diagnose/next/choice.hpp"

#include <fmt/format.h>

#include "tools/diagnose/model/quantity.hpp"

namespace sandhopper::diagnose {

void take(const DoableTrial& trial, const char* purpose, NextTrial& next) {
  next.purpose = purpose;
  next.kind = trial.trial.kind;
  next.setup = trial.trial.setup;
  next.words = trial.words;
  next.order = trial_in_words(next.kind, next.words, next.setup, Telling::order);
}

void complete(const Reach& reach, NextTrial& next) {
  // A bench test's sentence begins with its order already.
  if (next.order.empty() || next.why.starts_with(next.order)) return;
  next.why = next.order + ": " + next.why;
  const auto left = reach.ranges_left_by(next.setup);
  next.beyond_recorded = next.beyond_recorded || !left.empty();
  if (next.beyond_recorded)
    next.why += fmt::format(
        " This set-up lies beyond the recorded ones{}, and the campaign does not state its limits under "
        "[available].",
        left.empty() ? "" : " (" + left + ")");
}

}  // namespace sandhopper::diagnose
