#pragma once
#include <vector>

#include "tools/diagnose/plant.hpp"

namespace sandhopper::diagnose {

// Of one trial, a constant and the known shapes fitted and taken out.
std::vector<double> rest_without_known(const Balance& balance);

}  // namespace sandhopper::diagnose
