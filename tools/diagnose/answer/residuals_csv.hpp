#pragma once
#include <string>

#include "tools/diagnose/answer/diagnosis.hpp"

namespace sandhopper::diagnose {

// Recorded minus simulated, row by row, for tools of the reader's own: trial, channel, phase, t_s, before (as
// believed), after (with what was found, its sizes from the other trials) and the noise's standard deviation,
// in the channel's unit.
std::string residuals_csv(const Diagnosis& diagnosis);

}  // namespace sandhopper::diagnose
