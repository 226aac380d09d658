#pragma once
#include <vector>

#include "tools/diagnose/fit/prepare.hpp"
#include "tools/diagnose/fit/problem.hpp"

namespace sandhopper::diagnose {

// Selects at most `count` trials, spread evenly over kind, set-up, length and signal energy. The selection
// does not depend on the order of the trials.
Recordings spread_over(const Recordings& recordings, std::size_t count);

// Makes starting points of problem `to` from points of problem `from`, for the same plant. Nuisances and
// tolerances are those of `null`. Points with an effect that `to` does not have are left out.
std::vector<Point> carried_over(const Problem& from, const std::vector<Point>& points, const Problem& to,
                                const Point& null);

}  // namespace sandhopper::diagnose
