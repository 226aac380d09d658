#pragma once
#include <algorithm>
#include <cmath>

#include "tools/diagnose/plants/inputs.hpp"

namespace sandhopper::diagnose {

// Speed with which the set-up lets the body go; 0: at rest, or not stated.
inline double stated_speed_mps(const Trial& trial) {
  return trial.setup_or("release_speed_mps", trial.setup_or("impact_speed_mps", 0.0));
}

// Standard deviation of the release speed of a trial whose set-up states `stated_mps`. A part of it may be a
// share of that speed; then it is 0 for a body that is let go at rest. `unstated_mps`: if [spread] has none.
inline double release_speed_sd_mps(const Belief& belief, double stated_mps, double unstated_mps) {
  if (!belief.has("spread.release_speed_relative"))
    return spread_of(belief, "spread.release_speed_mps", unstated_mps);
  return std::max(kExact, std::hypot(belief.value("spread.release_speed_mps"),
                                     belief.value("spread.release_speed_relative") * stated_mps));
}

}  // namespace sandhopper::diagnose
