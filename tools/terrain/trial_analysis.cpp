#include "tools/terrain/trial_analysis.hpp"

#include <array>

#include "tools/terrain/hop_trials.hpp"
#include "tools/terrain/leg_force_trials.hpp"
#include "tools/terrain/penetrometer_trials.hpp"
#include "tools/terrain/press_trials.hpp"
#include "tools/terrain/profile_trials.hpp"
#include "tools/terrain/stroke_trials.hpp"

namespace sandhopper {

std::span<const TrialAnalysis* const> all_analyses() {
  static const ProfileTrials profile;
  static const HopTrials hops;
  static const LegForceTrials leg_force;
  static const PressTrials presses;
  static const StrokeTrials strokes;
  static const PenetrometerTrials penetrations;
  static const std::array<const TrialAnalysis*, 6> all{&profile, &hops,    &leg_force,
                                                       &presses, &strokes, &penetrations};
  return all;
}

}  // namespace sandhopper
