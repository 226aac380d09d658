#pragma once
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "tools/campaign/available.hpp"
#include "tools/diagnose/fit/problem.hpp"

namespace sandhopper::diagnose {

// Input of a diagnosis: the trials of a campaign, each with its belief.
struct Recordings {
  PlantKind plant{};
  Belief belief;
  std::vector<Trial> trials;
  std::vector<Belief> beliefs;  // per trial: the campaign's belief with the values of the trial's set-up
  Available available{};        // set-ups of the next trial, as the campaign states them
  // Text of nominal.toml as the campaign's author wrote it; "" if there is none. Empty for recordings that do
  // not come from a folder: the corrected model then states every number of `belief`.
  std::optional<std::string> model_text{};
  std::map<std::string, std::set<std::string>> words{};  // recorded set-up values that are words, by key
};

struct Prepared {
  Problem problem;
  std::vector<std::string> left_out;          // "trial: why"
  std::vector<std::string> missing_channels;  // never recorded, or constant
};

// Builds the problem: simulations of all trials, candidates, tolerances, and a first white noise model from
// the fast fluctuation of the recordings and the believed noise. `stretch`: index of PlantModel::stretches.
Prepared prepare(const Recordings& recordings, std::size_t stretch = 0);

// Estimates the model error and the noise again at a better point. The noise is what a joint regression on
// all candidates and many laws of free form leaves, so that missing physics does not count as noise.
void update_noise(Problem& problem, const Point& point);

}  // namespace sandhopper::diagnose
