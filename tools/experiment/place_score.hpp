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

// Adds a session of first strides, one on each place. Its truth is the mean of the places' curves, at depths
// down to the deepest point of any. There must be one stride at least.
void score_session(std::span<const Place> session, const StiffnessConfig& config, PlacesScore& score);

}  // namespace sandhopper
