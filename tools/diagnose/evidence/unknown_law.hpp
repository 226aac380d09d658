#pragma once
#include <vector>

#include "tools/diagnose/discrepancy/free_laws.hpp"
#include "tools/diagnose/evidence/log_evidence.hpp"
#include "tools/diagnose/fit/fit.hpp"

namespace sandhopper::diagnose {

// A law of free form at one port, as a further hypothesis beside the effects of a point.
struct UnknownLaw {
  FreeFamily family;
  // Increase of the log evidence by the law. Its values w at the knots are integrated out under
  //   w ~ N(0, s^2 R),  R: correlation of an Ornstein-Uhlenbeck process along the knots, s:
  //   Limits::unknown_sizes
  double log_factor = 0.0;
};

// Every law of free form beside the effects of the point, most probable first. `times`: ratio of each
// repeatable model error to its learnt scale.
std::vector<UnknownLaw> unknown_laws(const Problem& problem, const Point& point,
                                     const std::vector<double>& times);

}  // namespace sandhopper::diagnose
