#pragma once
#include <atomic>
#include <cstdint>

namespace sandhopper {

// Error counts of a device on a slow bus since start. Its own thread counts, any thread may read.
struct DeviceCounters {
  std::atomic<std::uint32_t> failed_transfers{0};
  std::atomic<std::uint32_t> missed_edges{0};  // a sample without its data-ready edge, or an edge that did
                                               // not come
  std::atomic<std::uint32_t> invalid{0};       // frames or values that could not be used
};

}  // namespace sandhopper
