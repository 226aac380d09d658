#include "tools/terrain/trial_analysis.hpp"

#include <array>

#include "tools/terrain/hop_trials.hpp"
#include "tools/terrain/stroke_trials.hpp"

namespace sandhopper {

std::span<const TrialAnalysis* const> all_analyses() {
  static const HopTrials hops;
  static const StrokeTrials strokes;
  static const std::array<const TrialAnalysis*, 2> all{&hops, &strokes};
  return all;
}

}  // namespace sandhopper
