#pragma once
#include <optional>
#include <span>
#include <vector>

namespace sandhopper::calibrate {

// A step of the offset between two clocks.
struct ClockStep {
  double step_s = 0.0;    // the foreign clock was set forward by this
  double before_s = 0.0;  // the step lies between these two foreign times
  double after_s = 0.0;
};

// Finds a step larger than 10 ms: some foreign taps match ours at one offset, at least two others match only
// at another offset, and the two groups do not overlap in time.
std::optional<ClockStep> step_between_taps(const std::vector<double>& taps_s,
                                           const std::vector<double>& foreign_s);

// Finds a smaller step from at least six offsets. For every split with two offsets on both sides it fits
// offset(t) = a + b t + s [t > split] by least squares. It returns the split with the largest |s| relative to
// its 95 % interval (Student's t, n - 3 degrees of freedom) if |s| exceeds this interval and `least_s`.
std::optional<ClockStep> step_in_offsets(std::span<const double> foreign_s, std::span<const double> offset_s,
                                         double least_s);

}  // namespace sandhopper::calibrate
