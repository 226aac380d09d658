#pragma once
#include <atomic>
#include <cstdint>

namespace sandhopper {

// What went wrong on a slow bus since start. Counted by its thread, read by any.
struct DeviceCounters {
  std::atomic<std::uint32_t> failed_transfers{0};
  std::atomic<std::uint32_t> missed_edges{0};  // samples found, or missing, without their data-ready edge
  std::atomic<std::uint32_t> invalid{0};       // frames or values that could not be used
};

}  // namespace sandhopper
