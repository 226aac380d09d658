#pragma once
#include <string>

#include "tools/calibrate/outcome.hpp"

namespace sandhopper::calibrate {

// One calibration as a page: verdict, values before and after, refusals, and plots.
Study page_of(const Outcome& outcome, const std::string& name, const std::string& date);

}  // namespace sandhopper::calibrate
