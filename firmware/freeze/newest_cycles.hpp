#pragma once
#include <filesystem>
#include <optional>
#include <vector>

#include "firmware/freeze/freeze_cycle.hpp"
#include "firmware/log/log_recovery.hpp"

namespace sandhopper {

struct NewestCycles {
  std::filesystem::path source;
  std::vector<FreezeCycle> cycles;  // oldest first
};

// The last cycles of the trial that this log is of, from a ring, a dump or a freeze frame in one of the
// folders; of several the one that goes on longest. Same trial: the cycles of both lie on the same grid of
// time, to the nanosecond.
std::optional<NewestCycles> find_newest_cycles(const LoggedCycles& log,
                                               const std::vector<std::filesystem::path>& folders);

}  // namespace sandhopper
