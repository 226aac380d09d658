#pragma once
#include <cstdint>

#include "firmware/watchdog/heartbeat.hpp"

namespace sandhopper {

// How long the beats have stood still, by the looks taken at them: never longer than they did, and shorter by
// at most the time between two looks. Before the first beat and after the last nothing stands still.
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
