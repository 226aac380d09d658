#pragma once
#include <map>
#include <set>
#include <string>
#include <vector>

#include "tools/campaign/available.hpp"
#include "tools/diagnose/fit/problem.hpp"

namespace sandhopper::diagnose {

// What a campaign gives to the fit: its trials with what each is read against.
struct Recordings {
  PlantKind plant{};
  Belief belief;
  std::vector<Trial> trials;
  std::vector<Belief> beliefs;  // per trial: the campaign's with the set-up's own values
  Available available{};        // set-ups of the next trial, as the campaign states them
  std::map<std::string, std::set<std::string>> words{};  // of the recorded set-ups, by key
};

struct Prepared {
  Problem problem;
  std::vector<std::string> left_out;  // "trial: why"
  std::vector<std::string> missing_channels;
};

// Makes simulations of all trials, candidates, tolerances, and the noise model: fast fluctuation first, then
// what a regression on every candidate and many free laws together leaves, so that what is missing does not
// pass for noise.
Prepared prepare(const Recordings& recordings);

// Estimates the model error and the noise again at a better point.
void update_noise(Problem& problem, const Point& point);

}  // namespace sandhopper::diagnose
