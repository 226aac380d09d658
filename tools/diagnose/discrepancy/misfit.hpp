#pragma once
#include <cstddef>
#include <vector>

namespace sandhopper::diagnose {

inline constexpr std::size_t kTooFewTrials = 3;  // Smallest number of trials for statements about all trials.

// Residual deviance per row, above the noise, from which it is large.
inline constexpr double kMuchPerRow = 0.5;
// Gain of the deviance per row above which an effect is never too small to be named, and a law of free form
// is no error in the form of the named laws.
inline constexpr double kUnmistakablePerRow = 0.3;

// Deviance that an explanation leaves above the noise (expected deviance: 1 per row).
struct Misfit {
  double unexplained = 0.0, explained = 0.0;
  bool large = false;       // Too large to trust any named effect.
  bool outweighs = false;   // More than a true effect with a law of another form leaves.
  bool noticeable = false;  // Large enough to look at the force balances.
};

// Deviance and number of rows of one trial.
struct TrialMisfit {
  double deviance = 0.0, rows = 0.0;
};

// `null_deviance`: deviance without any effect. With prescribed motion a simulation cannot diverge, so two
// trials with a large residual are enough; otherwise half of the trials must have one.
Misfit misfit_of(const std::vector<TrialMisfit>& trials, double null_deviance, bool motion_is_prescribed);

}  // namespace sandhopper::diagnose
