#pragma once
#include <map>
#include <vector>

#include "tools/diagnose/evidence/search.hpp"

namespace sandhopper::diagnose {

// How sure the search is, by comparing all sets it fitted. Differences of the penalised deviance count less
// where the best set itself leaves something unexplained: `remainder` is what free laws would still explain
// on held-out trials.
struct Posterior {
  // A rival whose deviance is this much larger, over the dispersion, is no alternative; and by how much that
  // grows with every unit that a further trial gives the answer to explain.
  double apart = 6.0;
  double apart_per_explained = 0.0;
  std::map<std::size_t, double> probability;  // of each effect of the best set or one of its alternatives
  std::map<std::size_t, std::vector<std::size_t>> alternatives;  // that explain as much in its place
};
Posterior posterior(const Problem& problem, const Search& search, double remainder);

}  // namespace sandhopper::diagnose
