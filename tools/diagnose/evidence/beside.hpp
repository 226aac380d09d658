#pragma once
#include <string>
#include <vector>

#include "tools/diagnose/evidence/search.hpp"

namespace sandhopper::diagnose {

// Of the fitted sets with at most as many effects as the best one, makes the most probable one the best, if
// the present best set is less probable by more than Limits::exchangeable. The criterion of the search counts
// neither the form of a law nor how finely the parameters and nuisances of a set must be tuned: a weightless
// body whose trials each have their own speed fits a terminal speed better than a drag does.
void name_likeliest(Problem& problem, Search& search, std::vector<std::string>& log);

// Appends to `log` the posterior mass of the sets with the smallest criterion, and of unknown laws added to
// the best set and to the null (one line each, most probable first).
void tell_evidence(Problem& problem, const Search& search, std::vector<std::string>& log);

}  // namespace sandhopper::diagnose
