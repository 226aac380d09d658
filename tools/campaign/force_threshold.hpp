#pragma once
#include <cstddef>
#include <optional>

#include "tools/campaign/force_at_depth.hpp"

namespace sandhopper {

// A recorder that writes one value, usually 0, for every force below a limit.
struct ForceThreshold {
  double held_N = 0.0;       // what it writes instead
  double least_N = 0.0;      // smallest distance of a measured force from it
  double depth_m = 0.0;      // greatest depth with the held value
  std::size_t rows = 0;      // with it
  std::size_t last_row = 0;  // of the recording, the last of the first stretch
};

// A cell shows its noise in air as in the bed. So there is a threshold if
// - the force is one value from the first row to below depth 0, and so many rows without noise are no chance;
// - no force lies between it and a limit that is far above the usual change from row to row. A bed's force
//   grows from 0 on. A crust that breaks jumps, too, but the cell shows noise before.
std::optional<ForceThreshold> force_threshold(const ForceAtDepth& pairs);

}  // namespace sandhopper
