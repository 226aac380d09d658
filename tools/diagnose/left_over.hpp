#pragma once
#include <string>

#include "tools/diagnose/fit.hpp"
#include "tools/diagnose/problem.hpp"

// What no fit explained, held against what sensors make of nothing. Where it passes for noise, a deviance
// says nothing of it.
namespace sandhopper::diagnose {

// Standard deviation that the belief states for a channel's sensor; 0: it says nothing.
double believed_noise(const Belief& belief, const std::string& channel);

// The noise over the sensors' own fast fluctuation: geometric mean over the channels.
double noise_over_sensors(const Problem& problem);

// Root mean square of what a fit leaves over that of the noise, sample by sample and not whitened (whitening
// hides what changes slowly): of the middle trial, and of the channel that shows most among those whose noise
// the belief states. 0 where it states none, or for fewer than three trials.
double left_over_noise(const Problem& problem, const Fit& fit);

// By how much standard deviations, and those of what is new in each sample, differ: root mean square of both
// logarithms over samples.
double noise_change(const NoiseModel& before, const NoiseModel& now);

}  // namespace sandhopper::diagnose
