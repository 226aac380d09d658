#pragma once
#include "tools/plant/world.hpp"

namespace sandhopper {

// Inside tools/bench the emulated robot is hung up again through a Unix socket, whose path is in
// SANDHOPPER_BENCH_SOCKET. One line a request, "reset seed=1 height=0.0618 noise=on"; the answer is "ok" or a
// message.
bool on_virtual_bench();

// Throws std::runtime_error with the bench's answer when it refuses.
void reset_bench(const TrialSetup& setup);

}  // namespace sandhopper
