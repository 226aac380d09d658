#pragma once
#include <string>
#include <vector>

#include "tools/conceal/case.hpp"

namespace sandhopper::conceal {

struct Visibility {
  std::string channel;
  double ratio = 0.0;
};

// How far two sets of hidden effects set the recordings of one case apart: root mean square of the difference
// in a channel over that between two repeats of the same trial with nothing hidden; the channel that differs
// most. Both recordings draw the same noise, so that only the effects differ.
Visibility difference(const Case& c, const std::vector<HiddenEffect>& one,
                      const std::vector<HiddenEffect>& other);

// From nothing hidden.
Visibility visibility(const Case& c, const std::vector<HiddenEffect>& hidden);

}  // namespace sandhopper::conceal
