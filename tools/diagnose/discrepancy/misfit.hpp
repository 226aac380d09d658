#pragma once
#include <cstddef>
#include <vector>

namespace sandhopper::diagnose {

inline constexpr std::size_t kTooFewTrials = 3;  // to say what holds for all

// How much an explanation leaves beyond the noise, whose own deviance is 1 a row.
struct Misfit {
  double unexplained = 0.0, explained = 0.0;
  bool large = false;       // too much for any name to be trusted
  bool outweighs = false;   // more than a true effect under another law would leave of what is explained
  bool noticeable = false;  // enough to ask the balances
};

struct TrialMisfit {
  double deviance = 0.0, rows = 0.0;
};

// `null_deviance`: with nothing explained. Where the motion is prescribed one trial does not lead others
// astray, and two that are left far are enough; else it takes half of them.
Misfit misfit_of(const std::vector<TrialMisfit>& trials, double null_deviance, bool motion_is_prescribed);

}  // namespace sandhopper::diagnose
