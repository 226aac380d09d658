#pragma once
#include <vector>

#include "tools/diagnose/fit/problem.hpp"

namespace sandhopper::diagnose {

// How far a torque constant or an accelerometer's scale may be off is believed as what trials differ by, but
// trials of one robot mostly share it. Where a fit shows that they differ far less than that or than by what
// they are off together, the nuisance's standard deviation becomes twice what is seen, at least a twentieth
// of what was believed, and begins again at nothing: what all share is an effect's to explain. Returns where
// a search may begin with these effects; empty where no nuisance changed.
std::vector<Point> take_spread_as_seen(Problem& problem, Point& point);

}  // namespace sandhopper::diagnose
