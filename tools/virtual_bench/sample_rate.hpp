#pragma once
#include <algorithm>

namespace sandhopper::bench {

// A chip set to a slower rate than the world's sensor delivers: which of the world's samples it takes.
class SampleRate {
 public:
  explicit SampleRate(double world_rate_Hz) : world_rate_Hz_(world_rate_Hz) {}

  // A chip that is faster than the world takes each sample once.
  bool takes_next(double chip_rate_Hz) noexcept {
    if (chip_rate_Hz <= 0.0) return false;
    share_ += std::min(chip_rate_Hz / world_rate_Hz_, 1.0);
    constexpr double kAlmostOne = 0.999;  // nominal rates are not exact multiples of each other
    if (share_ < kAlmostOne) return false;
    share_ = std::max(share_ - 1.0, 0.0);
    return true;
  }

 private:
  double world_rate_Hz_;
  double share_ = 0.0;
};

}  // namespace sandhopper::bench
