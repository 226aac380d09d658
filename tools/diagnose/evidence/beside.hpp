#pragma once
#include <string>
#include <vector>

#include "tools/diagnose/evidence/search.hpp"

namespace sandhopper::diagnose {

// The posterior mass of the sets that a search puts first, and of unknown laws beside its best and alone: one
// line each, the likeliest first. It decides nothing yet.
void tell_evidence(Problem& problem, const Search& search, std::vector<std::string>& log);

}  // namespace sandhopper::diagnose
