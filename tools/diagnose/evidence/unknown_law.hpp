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

bool is_same_law(const UnknownLaw& a, const UnknownLaw& b);

// Every law of free form beside what the point holds, the likeliest first.
// `scales`: of model error there.
std::vector<UnknownLaw> unknown_laws(const Problem& problem, const Point& point,
                                     const ErrorScales& scales, const Signatures& signatures);

// The law beside what stands at a fit, all fitted together through the simulation; its sizes and their
// standard deviations become those of that fit. The fit itself where none is closer.
Fit with_law_fitted(const Problem& problem, const Fit& at, UnknownLaw& law);

// A set of effects and an unknown law, fitted together.
struct LawBeside {
  std::vector<std::size_t> set;
  UnknownLaw law;
  Fit fit;
  double log_mass = 0.0;
  bool agreed = false;  // it brings the trials nearer
};

// The likeliest laws beside a fit, one of each port, fitted and weighed. `laws`: of unknown_laws there.
std::vector<LawBeside> weighed_laws(const Problem& problem, const std::vector<std::size_t>& set, const Fit& fit,
                                    const std::vector<UnknownLaw>& laws, std::size_t most);

}  // namespace sandhopper::diagnose
