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

// Last cycles of the trial of this log, from a ring, a dump or a freeze frame in one of the folders. If
// several match, the one that ends last is taken. A file matches if its cycles lie on the same time grid, to
// the nanosecond.
std::optional<NewestCycles> find_newest_cycles(const LoggedCycles& log,
                                               const std::vector<std::filesystem::path>& folders);

}  // namespace sandhopper
