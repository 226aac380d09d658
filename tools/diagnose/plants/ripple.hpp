#pragma once
#include <vector>

#include "tools/diagnose/model/context.hpp"

namespace sandhopper::diagnose {

// Orders (periods per revolution) of a torque ripple, at most three, the strongest first: local maxima over n
// from `first` to `last` of
//   |sum_k torques_k exp(-i n angles_k)|^2
std::vector<double> strongest_orders(const std::vector<double>& angles, const std::vector<double>& torques,
                                     int first, int last);

}  // namespace sandhopper::diagnose
