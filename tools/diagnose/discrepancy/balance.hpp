#pragma once
#include <vector>

#include "tools/diagnose/discrepancy/open_world.hpp"

namespace sandhopper::diagnose {

// `balance.rest` minus the least-squares fit of a constant and the known shapes, in the unit of `rest`.
std::vector<double> rest_without_known(const Balance& balance);

// Fits laws of free form to the balances of all trials: piecewise linear functions of one variable at one
// port. Each trial is weighted by 1 / its sum of squares and has a free constant (offsets of the sensors);
// the known shapes are eliminated. Each law is judged on trials left out: `held_out` is the mean fraction of
// a trial's variance that a law fitted to the other trials explains. Sorted by `held_out`, largest first.
// Ports with fewer than three usable trials are left out.
std::vector<FreeGain> laws_of_balances(const Problem& problem, const std::vector<Balance>& balances);

}  // namespace sandhopper::diagnose
