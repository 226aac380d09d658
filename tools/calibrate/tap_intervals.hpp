#pragma once
#include <string>
#include <vector>

#include "tools/calibrate/outcome.hpp"

namespace sandhopper::calibrate {

// Refusal "taps_differ" for foreign taps that fit ours at no shift. If most intervals between neighbouring
// foreign taps are also intervals between two of ours, it names the first that is not, with the time that is
// missing in it or too much: rows were lost there, or the clock stepped. Else it compares the medians.
Refusal different_taps(const std::string& name, const std::vector<double>& ours_s,
                       const std::vector<double>& theirs_s);

}  // namespace sandhopper::calibrate
