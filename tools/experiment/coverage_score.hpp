#pragma once
#include "terrain/strength_profile.hpp"
#include "tools/plant/bed_truth.hpp"

namespace sandhopper {

struct CoverageScore {
  double depths = 0.0;         // number of depths at which the band was compared: visited by the foot, from 2
                               // mm on
  double covered = 0.0;        // true value inside mean +- 1.96 sd
  double squared_error = 0.0;  // sum of ((mean - truth) / truth)^2
  double share() const { return covered / depths; }
};

// Adds the depths from `from_m` to `to_m`, 1 mm apart.
void score_band(const StrengthProfile& profile, const BedTruth& truth, double from_m, double to_m,
                CoverageScore& score);

}  // namespace sandhopper
