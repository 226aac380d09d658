#pragma once
#include <vector>

#include "tools/diagnose/discrepancy/open_world.hpp"

namespace sandhopper::diagnose {

// Of one trial, a constant and the known shapes fitted and taken out.
std::vector<double> rest_without_known(const Balance& balance);

// Laws of free form of one variable at one port, fitted to the balances of all trials (each weighed by its
// own variance, a constant of each trial free for the sensors' offsets, what is known taken out) and judged
// on trials left out; `held_out` is the share of a trial's variance that the other trials' law explains. The
// clearest first.
std::vector<FreeGain> laws_of_balances(const Problem& problem, const std::vector<Balance>& balances);

}  // namespace sandhopper::diagnose
