#include "tools/experiment/coverage_score.hpp"

#include <algorithm>
#include <cmath>

namespace sandhopper {

void score_band(const StrengthProfile& profile, const BedTruth& truth, double from_m, double to_m,
                CoverageScore& score) {
  constexpr double kFirstDepth_m = 0.002;  // at smaller depths the surface error is larger than the force
  constexpr double kPitch_m = 0.001;
  const double first_m = kPitch_m * std::ceil(std::max(from_m, kFirstDepth_m) / kPitch_m);
  for (double z = first_m; z <= std::min(to_m, kProfileDepth_m); z += kPitch_m) {
    const auto claim = force_at(profile, z);
    const double true_N = truth.force_at_N(z);
    score.depths += 1.0;
    score.covered += claim.low() <= true_N && true_N <= claim.high();
    score.squared_error += (claim.value / true_N - 1.0) * (claim.value / true_N - 1.0);
  }
}

}  // namespace sandhopper
