#pragma once
#include <string>
#include <vector>

#include "tools/diagnose/fit/prepare.hpp"

namespace sandhopper::diagnose {

// A stretch of one trial that is unlike all others, e.g. a hand pushes or an end stop is hit. It happens
// once, so it is no law, but it would dominate a fit.
struct Event {
  std::size_t trial = 0;  // index in Problem::trials
  double from_s = 1e300, to_s = -1e300;
  std::string channel;        // with the largest residual relative to its noise
  double furthest = 0.0;      // largest residual there, in the channel's unit
  double times_others = 0.0;  // rms residual over the noise, relative to that of the next stretch
};

// Finds events in trials that are simulated in at least four stretches: at most one in 40 stretches, each
// with a mean squared residual over the noise that is 25 times that of any other. `point`: the fit with all
// effects that were found.
std::vector<Event> find_events(const Problem& problem, const Point& point);

// Empties the cells of these stretches in `recordings`.
void leave_out(const std::vector<Event>& events, const Problem& problem, Recordings& recordings);

}  // namespace sandhopper::diagnose
