#pragma once
#include <vector>

#include "tools/diagnose/evidence/log_evidence.hpp"
#include "tools/diagnose/fit.hpp"
#include "tools/diagnose/free_laws.hpp"
#include "tools/diagnose/signatures.hpp"

namespace sandhopper::diagnose {

// A law of free form at one port, as a hypothesis beside what a point holds.
struct UnknownLaw {
  FreeFamily family;
  // ln of what it makes of the evidence: the law's sizes integrated out under
  //   w ~ N(0, s^2 R),  R an Ornstein-Uhlenbeck process along the knots, s one of Limits::unknown_sizes
  double log_factor = 0.0;
  double gain = 0.0;      // drop of the deviance
  double held_out = 0.0;  // the same on trials it was not fitted to
  double p_value = 1.0;   // trials as units, this law alone
  bool agreed = false;    // trials agree on it: what the others say helps each
  Eigen::VectorXd size, sd;  // of each knot, in scales of the port
};

// Every law of free form beside what the point holds, the likeliest first.
// `scales`: of model error there.
std::vector<UnknownLaw> unknown_laws(const Problem& problem, const Point& point,
                                     const ErrorScales& scales, const Signatures& signatures);

// The law beside what stands at a fit, all fitted together through the simulation; its sizes and their
// standard deviations become those of that fit. The fit's own point where none is closer.
Point with_law_fitted(const Problem& problem, const Fit& at, UnknownLaw& law);

}  // namespace sandhopper::diagnose
