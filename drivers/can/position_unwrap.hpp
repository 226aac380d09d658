#pragma once

namespace sandhopper {

// Unwraps a position that lies within -range..+range and wraps at the ends. A step of more than half the span
// between two samples is a wrap, because no motor turns that far in that time.
class PositionUnwrap {
 public:
  double unwrap(double position_rad, double range_rad) noexcept {
    if (started_) {
      const double step = position_rad - last_rad_;
      if (step > range_rad) offset_rad_ -= 2.0 * range_rad;
      if (step < -range_rad) offset_rad_ += 2.0 * range_rad;
    }
    started_ = true;
    last_rad_ = position_rad;
    return position_rad + offset_rad_;
  }

 private:
  bool started_ = false;
  double last_rad_ = 0.0;
  double offset_rad_ = 0.0;
};

}  // namespace sandhopper
