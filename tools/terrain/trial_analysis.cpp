#include "tools/terrain/trial_analysis.hpp"

#include <array>

#include "tools/terrain/hop_trials.hpp"

namespace sandhopper {

std::span<const TrialAnalysis* const> all_analyses() {
  static const HopTrials hops;
  static const std::array<const TrialAnalysis*, 1> all{&hops};
  return all;
}

}  // namespace sandhopper
