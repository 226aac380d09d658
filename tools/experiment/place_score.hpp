#pragma once
#include <span>
#include <vector>

#include "terrain/joint_fit.hpp"
#include "terrain/profile_sums.hpp"
#include "tools/experiment/bed_strides.hpp"
#include "tools/experiment/coverage_score.hpp"

// Band of the curve that several places of one ground have in common.
namespace sandhopper {

// First stride on a place.
struct Place {
  ProfileSums sums{};
  BedTruth truth{};
  double deepest_m = 0.0;
};

struct PlacesScore {
  int places = 0;
  double sessions = 0.0;
  CoverageScore band{};
};

// The curve of such a bed has the same form on every place: only its strengths and its grains differ.
bool has_common_curve(const BedCase& bed);

// Joins the strides in their order to sessions of `places` places. The truth of a session is the mean of its
// places' curves, at depths down to the deepest point of any. Strides that fill no session are left out.
PlacesScore score_places(std::span<const Place> strides, int places, const StiffnessConfig& config);

}  // namespace sandhopper
