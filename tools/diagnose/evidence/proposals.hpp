#pragma once
#include <vector>

#include "tools/diagnose/fit/problem.hpp"

namespace sandhopper::diagnose {

// A set of effects that looks worth a fit, with where the fit may start.
struct Proposal {
  Hypothesis start;
  double deviance = 0.0;  // as the linear approximation has it, with what the set itself costs
};

// All singles and pairs, and what the best of them grow to, weighed in one linear approximation at `point`:
// its own effects are put back into the residual, so that a set may do without them. Forward search finds no
// pair of which neither half helps alone; this does. The best `count` first, then as many that have one of
// the point's own effects exchanged for another: what cannot be told from it is found there.
std::vector<Proposal> propose(const Problem& problem, const Point& point, std::size_t most_effects,
                              std::size_t count, double cost_of_an_effect);

}  // namespace sandhopper::diagnose
