#pragma once
#include <algorithm>
#include <cstdint>

namespace sandhopper {

// Maps the companion's clock onto ours. Arrival minus device time is the offset of the clocks plus a delay
// that varies; its least value is followed, and may rise by 200 ppm so that a clock that runs slow is
// followed too.
class CompanionClock {
 public:
  // Device time on our clock as if every frame took the shortest way.
  std::int64_t map(std::int64_t device_ns, std::int64_t arrival_ns) noexcept {
    const auto offset = arrival_ns - device_ns;
    if (!known_ || device_ns < last_device_ns_) {
      offset_ns_ = offset;  // first frame, or the companion has restarted
    } else {
      const auto allowance = (device_ns - last_device_ns_) / 5000;
      offset_ns_ = std::min(offset, offset_ns_ + allowance);
    }
    known_ = true;
    last_device_ns_ = device_ns;
    return device_ns + offset_ns_;
  }

 private:
  bool known_ = false;
  std::int64_t offset_ns_ = 0;
  std::int64_t last_device_ns_ = 0;
};

}  // namespace sandhopper
