#pragma once
#include <vector>

#include "tools/diagnose/fit/problem.hpp"

namespace sandhopper::diagnose {

// A set of effects that deserves a fit, with start values for the fit.
struct Proposal {
  Hypothesis start;
  double deviance = 0.0;  // Deviance in the linear approximation, plus the cost of the set's effects.
};

// Scores all single effects, all pairs and extensions of the best pairs in one linear approximation at
// `point`. The point's own effects are added back to the residual, so a set may lack them. This finds pairs
// of effects that help only together; forward search does not. Returns the best `count` sets, then up to
// `count` sets in which one of the point's own effects is exchanged for another: indistinguishable effects
// appear there.
std::vector<Proposal> propose(const Problem& problem, const Point& point, std::size_t most_effects,
                              std::size_t count, double cost_of_an_effect);

}  // namespace sandhopper::diagnose
