#pragma once
#include <vector>

#include "tools/diagnose/evidence/search.hpp"

namespace sandhopper::diagnose {

// Posterior masses of fitted sets of effects, as they would be on average over repetitions of the campaign
// ("bagged posterior": Huggins and Miller, Bayesian Analysis 18, 2023, pp. 79-104):
//   mass(S) = mean over w of Z_w(S) p(S) / sum_S' Z_w(S') p(S'),   w ~ n Dirichlet(1, ..., 1)
// Z_w: evidence with trial t counted w_t times (log_evidence.hpp), p: log_prior, n: number of trials. The
// weights stand for resampled trials (Rubin, Annals of Statistics 9, 1981, pp. 130-134); they are the same in
// every call. If a set is true, all trials agree and the mean hardly differs from the posterior mass itself.
// If none is, a few trials decide which one has the largest evidence, by a factor that means nothing; other
// trials would decide otherwise, and the mean shows that. A set whose evidence is not finite has the mass 0.
std::vector<double> bagged_masses(const Problem& problem, const std::vector<const SetFit*>& fits);

}  // namespace sandhopper::diagnose
