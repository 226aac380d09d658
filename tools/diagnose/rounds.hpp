#pragma once
#include "tools/diagnose/discrepancy/unexplained.hpp"
#include "tools/diagnose/engine.hpp"
#include "tools/diagnose/evidence/search.hpp"

namespace sandhopper::diagnose {

inline constexpr double kOfRest = 0.85;  // usual share of the work that is done when the search ends

// Searches for the missing effects in rounds:
//   1. With the noise estimated at the fit without effects, sets of effects are searched; for a costly plant
//      only single effects. Until the strongest effect is found, it raises the estimated noise most.
//   2. and 3. The noise is estimated at the best set, and the search is repeated from its best points.
//   last: For a costly plant every other effect is fitted beside the best set. The screens of a cheap plant
//      fit enough effects each.
// If something happened once in one trial, that stretch is left out of `prepared` and `clean`, and all rounds
// are repeated.
Search search_in_rounds(Prepared& prepared, Recordings& clean, const EngineOptions& options,
                        BalanceLaw& balance, Diagnosis& diagnosis);

}  // namespace sandhopper::diagnose
