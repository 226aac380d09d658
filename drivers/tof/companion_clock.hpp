#pragma once
#include <algorithm>
#include <cstdint>

namespace sandhopper {

// Maps the companion controller's clock to ours. Arrival minus device time is the offset of the clocks plus a
// varying delay. The estimate is the smallest such difference. It may rise by 200 ppm, so that it also
// follows a companion clock that runs slow.
class CompanionClock {
 public:
  // Device time on our clock, as if every frame had the shortest delay.
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
