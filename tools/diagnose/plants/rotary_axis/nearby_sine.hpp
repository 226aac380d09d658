#pragma once
#include <cmath>

namespace sandhopper::diagnose {

// Sine of angles near a given one, by a Taylor series; error 2e-9. One step of the simulation needs several.
class NearbySine {
 public:
  explicit NearbySine(double angle) : at_(angle), sine_(std::sin(angle)), cosine_(std::cos(angle)) {}
  double operator()(double angle) const {
    const double d = angle - at_, q = d * d;
    if (q > 0.01) return std::sin(angle);
    return sine_ * (1.0 - q * (0.5 - q / 24.0)) + cosine_ * d * (1.0 - q * (1.0 / 6.0 - q / 120.0));
  }

 private:
  double at_, sine_, cosine_;
};

}  // namespace sandhopper::diagnose
