#pragma once
#include <cstdint>

#include "firmware/watchdog/heartbeat.hpp"

namespace sandhopper {

// Time [ns] for which the beats have stood still, as observed at each call of see(). It is never too long,
// and too short by at most the time between two calls. Before the first beat and after the end it is 0.
class StallDetector {
 public:
  std::int64_t see(const Heartbeat& heart, std::int64_t now_ns) noexcept {
    const auto beats = heart.beats();
    if (beats != last_beats_ || !heart.beating()) {
      last_beats_ = beats;
      since_ns_ = now_ns;
    }
    return now_ns - since_ns_;
  }

 private:
  std::uint64_t last_beats_ = 0;
  std::int64_t since_ns_ = 0;
};

}  // namespace sandhopper
