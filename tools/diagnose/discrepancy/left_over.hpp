#pragma once
#include <optional>
#include <string>
#include <vector>

#include "tools/diagnose/fit/fit.hpp"
#include "tools/diagnose/fit/problem.hpp"

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

// A channel whose noise, with all in place that was found, is far beyond what its sensor is believed to make:
// what comes and goes at no set time, depth or speed passes for noise.
struct LoudChannel {
  std::string channel;
  double times = 1.0;  // the sensor's own
  std::string port;    // the channel where the sensor alone is loud, else the plant's first
};
// The loudest of those whose noise the belief states. With nothing missing, or the right names in place, a
// second and a third program's were at most 1.45, heights that wander (seed 9101) up to 3.2; hum and ringing
// 5.6 and more.
std::optional<LoudChannel> loudest_channel(const Problem& problem);

// A nuisance that all trials move alike.
struct Lean {
  std::string nuisance, port;
  double z = 0.0;  // mean of value / sd over the trials, times the square root of their number, at most 12
};
// Nuisances differ from trial to trial by what they are; one that is off by the same in all trials is no
// nuisance but something that is missing, and no deviance says so. The one that leans most first. With a
// hundred trials any small share of what they differ by would be certain, and is what a simulation may be off
// by: more than twelve count as twelve.
std::vector<Lean> leans_of(const Problem& problem, const Point& point);
Lean largest_lean(const Problem& problem, const Point& point);

// By how much standard deviations, and those of what is new in each sample, differ: root mean square of both
// logarithms over samples.
double noise_change(const NoiseModel& before, const NoiseModel& now);

}  // namespace sandhopper::diagnose
