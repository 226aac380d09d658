#pragma once
#include <string>
#include <vector>

#include "tools/conceal/case.hpp"

namespace sandhopper::conceal {

struct Visibility {
  std::string channel;
  double ratio = 0.0;
};

// How far the hidden effects move a recording: root mean square of the difference they make to a channel over
// that between two repeats of the same trial without them; the channel moved most. Both recordings of the
// first difference draw the same noise, so that only the effects differ.
Visibility visibility(const Case& c, const std::vector<HiddenEffect>& hidden);

}  // namespace sandhopper::conceal
