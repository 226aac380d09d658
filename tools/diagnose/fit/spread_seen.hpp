#pragma once
#include <vector>

#include "tools/diagnose/fit/problem.hpp"

namespace sandhopper::diagnose {

// Corrects the spread of nuisances that all trials share. The belief states how far a torque constant or an
// accelerometer's scale differs between trials, but trials of one robot mostly share one value. If a fit
// shows a spread far below the believed one, or far below the shared shift, the prior standard deviation
// becomes twice the spread seen, and at least a twentieth of the believed one. The nuisance then restarts at
// 0, because an effect should explain the shared value. Returns starting points for a search with these
// effects; empty if no nuisance changed.
std::vector<Point> take_spread_as_seen(Problem& problem, Point& point);

}  // namespace sandhopper::diagnose
