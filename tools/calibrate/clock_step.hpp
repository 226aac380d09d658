#pragma once
#include <optional>
#include <span>
#include <vector>

namespace sandhopper::calibrate {

// A place at which the offset between two clocks jumps.
struct ClockStep {
  double step_s = 0.0;    // the foreign clock was set forward by this
  double before_s = 0.0;  // foreign times between which it happened
  double after_s = 0.0;
};

// A step larger than 10 ms: some foreign taps fit ours at one offset, at least two others, all later or all
// earlier, only at another one.
std::optional<ClockStep> step_between_taps(const std::vector<double>& taps_s,
                                           const std::vector<double>& foreign_s);

// A smaller one, from at least six offsets: least squares of
//   offset(t) = a + b t + s [t > split]
// over every split with two offsets on both sides; the one whose s is largest against its 95 % interval
// (Student's t, n - 3 degrees of freedom), if it lies beyond it and beyond `least_s`.
std::optional<ClockStep> step_in_offsets(std::span<const double> foreign_s, std::span<const double> offset_s,
                                         double least_s);

}  // namespace sandhopper::calibrate
