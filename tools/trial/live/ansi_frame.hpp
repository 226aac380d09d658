#pragma once
#include <string>

#include "tools/trial/live/canvas.hpp"

namespace sandhopper {

struct TerminalTraits {
  bool colour = true;
  bool utf8 = true;  // false: blocks and dashes become ASCII
};

// Control sequences (ECMA-48: CUP, SGR, ED) that change a terminal from `before` to `after`. If the size
// differs the screen is cleared and drawn again. Only changes are sent, so nothing flickers and a slow line
// suffices.
std::string ansi_frame(const Canvas& before, const Canvas& after, const TerminalTraits& traits);

}  // namespace sandhopper
