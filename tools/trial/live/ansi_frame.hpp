#pragma once
#include <string>

#include "tools/trial/live/canvas.hpp"

namespace sandhopper {

struct TerminalTraits {
  bool colour = true;
  bool utf8 = true;  // else blocks and dashes become ASCII
};

// What must be sent to a terminal (ECMA-48: CUP, SGR, ED) that shows `before` so that it shows `after`; with
// another size the screen is cleared and drawn anew. Only what changed is sent: nothing flickers, and a slow
// line keeps up.
std::string ansi_frame(const Canvas& before, const Canvas& after, const TerminalTraits& traits);

}  // namespace sandhopper
