#pragma once
#include <vector>

#include "tools/diagnose/discrepancy/free_laws.hpp"
#include "tools/diagnose/evidence/screen.hpp"
#include "tools/diagnose/fit/fit.hpp"

namespace sandhopper::diagnose {

// What a free law at one port would still explain at a point, on trials it was not fitted to.
struct FreeGain {
  FreeFamily family;
  double held_out = 0.0;       // drop of the deviance
  double trials_better = 0.0;  // share of trials where it helps
  double p_value = 1.0;        // trials as units, for all families together
  Eigen::VectorXd size;
  Eigen::VectorXd sd;
};

// One-sided, trials as units: are held-out gains more than chance, given their own spread? Of their square
// roots at least `spread` is believed beforehand.
double p_of_gains(const std::vector<double>& gains, double spread);

// All families, the largest gain first.
std::vector<FreeGain> free_gains(const Problem& problem, const Point& point);

// The law beside what stands at a fit, all fitted together through the simulation; its sizes and their
// standard deviations become those of that fit. The fit's own point where none is closer.
Point with_law_fitted(const Problem& problem, const Fit& at, FreeGain& law);

}  // namespace sandhopper::diagnose
