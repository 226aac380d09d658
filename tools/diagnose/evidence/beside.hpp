#pragma once
#include <string>
#include <vector>

#include "tools/diagnose/evidence/search.hpp"

namespace sandhopper::diagnose {

// Appends to `log` the posterior mass of the sets with the smallest criterion, and of unknown laws added to
// the best set and to the null (one line each, most probable first). Nothing is decided by it yet.
void tell_evidence(Problem& problem, const Search& search, std::vector<std::string>& log);

}  // namespace sandhopper::diagnose
