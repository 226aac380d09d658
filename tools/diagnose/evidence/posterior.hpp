#pragma once
#include <map>
#include <vector>

#include "tools/diagnose/evidence/search.hpp"

namespace sandhopper::diagnose {

// Probabilities of the effects of the best set, from the weights exp(-difference of criterion / 2 /
// temperature) of all fitted sets that are not larger. `remainder`, the held-out gain of a free law beside
// the best set, raises the temperature: if the best set leaves much unexplained, differences between sets
// count less.
struct Posterior {
  // A rival whose deviance / dispersion exceeds the best one's by `apart` is no longer an alternative. A
  // further trial raises this limit by `apart_per_explained` times the deviance / dispersion that it gives
  // the answer to explain.
  double apart = 6.0;
  double apart_per_explained = 0.0;
  // Key: effect of the best set. Value: share of the weights of sets that hold it or one of its alternatives.
  std::map<std::size_t, double> mass;
  // Key: effect of the best set. Value: effects that explain as much in its place, most probable first.
  std::map<std::size_t, std::vector<std::size_t>> alternatives;
};
// Share of the explained deviance by which simulation errors and laws of another form can change it, with the
// plant's relative form error.
double share_in_doubt(double form_error);
// Temperature beside a law of free form with this held-out gain.
double temperature_with(double remainder);
Posterior posterior(const Problem& problem, const Search& search, double remainder);

}  // namespace sandhopper::diagnose
