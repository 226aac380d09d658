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

// A clock that runs at another rate, so that taps which are matched in their order drift apart.
struct ClockDrift {
  double fast = 0.0;        // foreign time per time of ours, less 1
  double residual_s = 0.0;  // largest distance of a tap from the line
  std::size_t taps = 0;
};

// Pairs at least five taps in a row, at the shift at which they lie nearest to the line ours = a + b theirs.
// Found if no pair is 10 ms from the line, the rate differs from 1 beyond its 95 % interval, the taps drift
// apart by more than 10 ms in all, and there is no step of more than `least_s` (step_in_offsets). Even taps
// fit at any rate: there the intervals must also agree within 10 ms.
std::optional<ClockDrift> drift_between_taps(const std::vector<double>& taps_s,
                                             const std::vector<double>& foreign_s, double least_s);

}  // namespace sandhopper::calibrate
