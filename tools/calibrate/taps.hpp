#pragma once
#include <string>
#include <vector>

#include "tools/calibrate/still.hpp"

namespace sandhopper::calibrate {

// Times of taps in a signal: local maxima of |signal - median| above a third of the largest value and above 8
// times the noise, at least 0.15 s apart. Refusals: too_few_points (fewer than `fewest`); double_tap (within
// 0.15 s the signal falls to 15 % of the tap and then exceeds a third of it). Times are those of the series.
struct TapLimits {
  std::size_t fewest;
  std::string what;  // name for the messages, for example "imu_foot"
};
std::vector<double> find_taps(const Series& signal, const TapLimits& limits, std::vector<Refusal>& refusals);

// Delay of `other` against `reference` around the tap: least squares of
//   other(t) = a + b reference(t - delay)
// over 15 ms on both sides. The reference is interpolated by Catmull-Rom cubics. The delay is searched within
// centre_s +- search_s.
struct Delay {
  double delay_s = 0.0;
  double gain = 0.0;
  double unexplained = 1.0;  // share of the variance of `other` that the fit leaves
  bool found = false;        // false: no minimum within the search range, or too few samples
};
struct DelaySearch {
  double tap_s;
  double search_s;
  double centre_s = 0.0;  // centre of the search range
};
Delay delay_of(const Series& reference, const Series& other, const DelaySearch& search);

}  // namespace sandhopper::calibrate
