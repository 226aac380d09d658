#pragma once
#include <string>
#include <vector>

#include "tools/diagnose/fit/prepare.hpp"

namespace sandhopper::diagnose {

// A stretch of one trial that no other stretch is like: a hand that pushes, a stop that is run into. What
// happens once is no law, and one such stretch outweighs all others in a fit.
struct Event {
  std::size_t trial = 0;  // of the problem's
  double from_s = 1e300, to_s = -1e300;
  std::string channel;  // that it moves furthest beyond its noise
  double furthest = 0.0;
  double times_others = 0.0;  // root mean square over its noise, against the next stretch's
};

// Of trials that are simulated in many stretches, each begun where it is recorded: those few whose mean
// square over the noise is 25 times that of any other, with everything in place that was found.
std::vector<Event> find_events(const Problem& problem, const Point& point);

// Empties their cells.
void leave_out(const std::vector<Event>& events, const Problem& problem, Recordings& recordings);

}  // namespace sandhopper::diagnose
