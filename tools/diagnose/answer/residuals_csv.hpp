#pragma once
#include <string>

#include "tools/diagnose/answer/diagnosis.hpp"

namespace sandhopper::diagnose {

// Residuals (recorded minus simulated) of every row as CSV: trial, channel, phase, t_s, before (null), after
// (with the findings, their sizes fitted to the other trials; without findings those of the belief),
// noise_sd. In the channel's unit.
std::string residuals_csv(const Diagnosis& diagnosis);

}  // namespace sandhopper::diagnose
