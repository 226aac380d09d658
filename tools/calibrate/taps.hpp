#pragma once
#include <string>
#include <vector>

#include "tools/calibrate/still.hpp"

namespace sandhopper::calibrate {

// Where a signal shows taps: local extremes of |signal - median| above a third of the largest and eight times
// the noise, the first of any 0.15 s. "too_few_points" below `fewest`; "double_tap" where a tap is followed
// by another of at least a third of its height within 0.15 s, after the signal had come down to half of it.
// Times are those of the series.
struct TapLimits {
  std::size_t fewest;
  std::string what;  // for the sentences: "imu_foot"
};
std::vector<double> find_taps(const Series& signal, const TapLimits& limits, std::vector<Refusal>& refusals);

// How much later `other` shows what `reference` shows around `tap_s`: the least squares of
//   other(t) = a + b reference(t - delay)
// over 15 ms on both sides, the reference through cubic (Catmull-Rom) pieces, delay within +-search_s.
struct Delay {
  double delay_s = 0.0;
  double gain = 0.0;
  double unexplained = 1.0;  // share of the other's scatter that is left
  bool found = false;        // false: no minimum within the search, or no samples
};
struct DelaySearch {
  double tap_s;
  double search_s;
  double centre_s = 0.0;  // where the search is centred
};
Delay delay_of(const Series& reference, const Series& other, const DelaySearch& search);

}  // namespace sandhopper::calibrate
