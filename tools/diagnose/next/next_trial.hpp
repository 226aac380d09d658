#pragma once
#include "tools/diagnose/answer/diagnosis.hpp"
#include "tools/diagnose/discrepancy/open_world.hpp"
#include "tools/diagnose/evidence/posterior.hpp"
#include "tools/diagnose/evidence/search.hpp"
#include "tools/diagnose/fit/prepare.hpp"

namespace sandhopper::diagnose {

// Chooses the next trial among set-ups that were recorded or that the campaign lists under [available], and
// fills diagnosis.next. If none of them separates the rivals: a set-up beyond the recorded ones in numbers
// that any lab can choose; else a test on the bench (bench_test.hpp), and the text names the set-up with
// another part that would separate them, if there is one.
//   split    rival explanations are left: xi* = argmax mean_ij log2(1 + min(lambda_ij(xi) / apart, enough)) -
//            cost(xi). No trial if a session of them would not separate a rival.
//   sharpen  one explanation: largest reduction of its parameters' variances
//   map      an unknown force: largest reduction of the variances of its curve
//   bound    nothing found: largest reduction of the widest bound. No trial if all bounds are narrow.
//   repeat   a faulty sensor: a recorded trial, after the repair
// lambda_ij: rise of j's deviance in trial xi if i is true, divided by the dispersion between trials. First
// the parameters of j (held by the information H_j so far), tolerances and the trial's nuisances are
// refitted:
//   lambda_ij = D'D - D'J_j (H_j + J_j'J_j)^-1 J_j'D,   D: whitened difference of the predictions
// The mean over pairs is used: the minimum would be decided by a pair that no trial can separate. `problem`
// is changed temporarily and restored.
void propose_next_trial(Problem& problem, const Recordings& recordings, Search& search,
                        const Posterior& belief, const FreeGain* rest, Diagnosis& diagnosis);

}  // namespace sandhopper::diagnose
