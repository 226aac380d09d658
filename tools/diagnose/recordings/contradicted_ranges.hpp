#pragma once
#include <string>
#include <vector>

#include "tools/diagnose/fit/prepare.hpp"

namespace sandhopper::diagnose {

// Takes out of the beliefs the ranges of sensors (`sensors.*_range_*`) that a recording exceeds by more than
// noise can: the simulation would stop there while the recording goes on. Returns one note for each.
std::vector<std::string> drop_contradicted_ranges(Recordings& recordings);

}  // namespace sandhopper::diagnose
