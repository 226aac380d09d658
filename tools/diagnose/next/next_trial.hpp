#pragma once
#include "tools/diagnose/answer/diagnosis.hpp"
#include "tools/diagnose/discrepancy/open_world.hpp"
#include "tools/diagnose/evidence/posterior.hpp"
#include "tools/diagnose/evidence/search.hpp"
#include "tools/diagnose/fit/prepare.hpp"

namespace sandhopper::diagnose {

// Chooses the trial worth doing next, among those whose set-up the campaign has recorded or lists under
// [available]; where none of them tells rivals apart, the reason says which other set-up would:
//   split    rivals that these recordings leave: xi* = argmax mean_ij log2(1 + min(lambda_ij(xi), enough)) -
//            cost(xi); none where a session of such trials would not tell one of them
//   sharpen  one explanation: the largest drop of its parameters' variances
//   map      an unknown force: the largest drop of its curve's variances
//   bound    nothing found: the largest drop of the widest bound; none where all are narrow
//   repeat   a sensor's fault: what was done, after its repair
// lambda_ij is the rise of j's deviance in trial xi when i is true, after j's parameters, held by the
// recordings there are, the clocks and the trial's own nuisances took up what they can:
//   lambda_ij = D'D - D'J_j (H_j + J_j'J_j)^-1 J_j'D,  D whitened difference of the predictions, H_j
//   information so far
// in units of the dispersion between trials. The mean, for with the least a pair that no trial splits would
// decide. Fills diagnosis.next. The problem is as it was afterwards.
void propose_next_trial(Problem& problem, const Recordings& recordings, Search& search,
                        const Posterior& belief, const FreeGain* rest, Diagnosis& diagnosis);

}  // namespace sandhopper::diagnose
