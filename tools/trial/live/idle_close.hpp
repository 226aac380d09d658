#pragma once
#include <cmath>
#include <cstdint>

namespace sandhopper {

// Says when a live view closes by itself: the trial has been over for `after_s` and nobody pressed a key
// since. 0: never.
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
  std::int64_t since_ns_ = 0;  // 0: it is not over, or somebody did something since
};

}  // namespace sandhopper
