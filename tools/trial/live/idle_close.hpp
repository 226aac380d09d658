#pragma once
#include <cmath>
#include <cstdint>

namespace sandhopper {

// Decides when a live view closes by itself: `after_s` after the end of the trial, or after the last key
// pressed since. 0: never.
class IdleClose {
 public:
  explicit IdleClose(double after_s) noexcept : after_ns_(std::llround(after_s * 1e9)) {}

  void key_pressed() noexcept { since_ns_ = 0; }

  // now_ns: CLOCK_MONOTONIC.
  bool is_due(bool is_over, std::int64_t now_ns) noexcept {
    if (!is_over || after_ns_ == 0) {
      since_ns_ = 0;
      return false;
    }
    if (since_ns_ == 0) since_ns_ = now_ns;
    return now_ns - since_ns_ > after_ns_;
  }

 private:
  std::int64_t after_ns_;
  std::int64_t since_ns_ = 0;  // start of the waiting time; 0: not waiting
};

}  // namespace sandhopper
