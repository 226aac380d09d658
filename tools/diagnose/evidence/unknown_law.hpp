#pragma once
#include <vector>

#include "tools/diagnose/discrepancy/free_laws.hpp"
#include "tools/diagnose/evidence/log_evidence.hpp"
#include "tools/diagnose/fit/fit.hpp"

namespace sandhopper::diagnose {

// A law of free form at one port, as a hypothesis beside what a point holds.
struct UnknownLaw {
  FreeFamily family;
  // ln of what it makes of the evidence: the law's sizes integrated out under
  //   w ~ N(0, s^2 R),  R an Ornstein-Uhlenbeck process along the knots, s one of Limits::unknown_sizes
  double log_factor = 0.0;
};

// Every law of free form beside what the point holds, the likeliest first.
// `times`: scale of each repeatable model error over the learned one.
std::vector<UnknownLaw> unknown_laws(const Problem& problem, const Point& point,
                                     const std::vector<double>& times);

}  // namespace sandhopper::diagnose
