#pragma once
#include <vector>

#include "tools/diagnose/model/context.hpp"

namespace sandhopper::diagnose {

// Orders of a ripple of `torques` over `angles`, the strongest first: local maxima over n of
// |sum r exp(-i n theta)|^2.
std::vector<double> strongest_orders(const std::vector<double>& angles, const std::vector<double>& torques,
                                     int first, int last);

}  // namespace sandhopper::diagnose
