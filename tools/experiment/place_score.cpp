#include "tools/experiment/place_score.hpp"

#include <algorithm>

namespace sandhopper {
namespace {

BedTruth mean_of(std::span<const Place> session) {
  BedTruth mean = session.front().truth;
  for (std::size_t i = 0; i < mean.force_N.size(); ++i) {
    mean.force_N[i] = 0.0;
    for (const auto& place : session)
      mean.force_N[i] += place.truth.force_N[i] / static_cast<double>(session.size());
  }
  return mean;
}

}  // namespace

bool has_common_curve(const BedCase& bed) {
  const auto& family = bed.family;
  return family.depth_spread_m == 0.0 && family.exponent_spread == 0.0;
}

void score_session(std::span<const Place> session, const StiffnessConfig& config, PlacesScore& score) {
  ProfileSolver solver(config);
  double deepest_m = 0.0;
  for (std::size_t i = 0; i < session.size(); ++i) {
    solver.add(session[i].sums, i == 0 ? 1 : ProfileSolver::kFreshGround);
    deepest_m = std::max(deepest_m, session[i].deepest_m);
  }
  score.sessions += 1.0;
  score_band(solver.profile(), mean_of(session), 0.0, deepest_m, score.band);
}

}  // namespace sandhopper
