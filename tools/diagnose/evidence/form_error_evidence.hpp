#pragma once
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "tools/diagnose/fit/prepare.hpp"

namespace sandhopper::diagnose {

// Log evidence of recordings in which one listed effect is missing, for each share s of the form error of
// laws (Limits::form and Limits::size_of_trial, both times s): ln Z(s) of log_evidence.hpp at the joint fit
// of that effect, with the noise estimated beside it. Shares that several programs prefer are what
// Limits::form_shares should hold. `effect`: its identifier, e.g. "terrain.added_mass"; of several channels
// the one that explains most counts. Empty if the effect cannot be in this campaign, is a reading (which has
// no form) or is not fitted. `progress` is called with 0, with 0.5 during the fits, and with 0.9.
std::vector<double> form_error_evidence(
    const Recordings& recordings, const std::string& effect, std::span<const double> shares,
    const std::function<void(double)>& progress = [](double) {});

}  // namespace sandhopper::diagnose
