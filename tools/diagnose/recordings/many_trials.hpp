#pragma once
#include <vector>

#include "tools/diagnose/fit/prepare.hpp"
#include "tools/diagnose/fit/problem.hpp"

namespace sandhopper::diagnose {

// At most `count` of the trials, spread evenly over their set-ups and, within one, over how long and how
// large they are: the same ones in whatever order they are given.
Recordings spread_over(const Recordings& recordings, std::size_t count);

// The effects found in one problem as a start in another, of the same plant: there each trial's nuisances are
// those of `null`. Points with an effect that the other problem cannot have are left out.
std::vector<Point> carried_over(const Problem& from, const std::vector<Point>& points, const Problem& to,
                                const Point& null);

}  // namespace sandhopper::diagnose
