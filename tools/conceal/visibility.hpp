#pragma once
#include <string>
#include <vector>

#include "tools/conceal/case.hpp"

namespace sandhopper::conceal {

// The most visible channel and its ratio.
struct Visibility {
  std::string channel;
  double ratio = 0.0;
};

// Visibility of the difference between two sets of hidden effects: RMS difference of a channel / RMS
// difference between two repeats of a trial without hidden effects, for the channel with the largest ratio.
// Both recordings have the same noise, so only the effects differ.
Visibility difference(const Case& c, const std::vector<HiddenEffect>& one,
                      const std::vector<HiddenEffect>& other);

// Visibility compared with no hidden effects.
Visibility visibility(const Case& c, const std::vector<HiddenEffect>& hidden);

}  // namespace sandhopper::conceal
