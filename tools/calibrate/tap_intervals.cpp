#include "tools/calibrate/tap_intervals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/calibrate/tap_alignment.hpp"

namespace sandhopper::calibrate {
namespace {

// Median time between neighbouring taps.
double median_interval_s(const std::vector<double>& taps) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < taps.size(); ++i) steps.push_back(taps[i] - taps[i - 1]);
  if (steps.empty()) return 0.0;
  std::ranges::nth_element(steps, steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2));
  return steps[steps.size() / 2];
}

// The time between two of our taps, not necessarily neighbours, that is nearest to `interval_s`.
double nearest_interval_s(const std::vector<double>& ours, double interval_s) {
  double nearest = 0.0;
  for (std::size_t i = 0; i < ours.size(); ++i)
    for (std::size_t j = i + 1; j < ours.size(); ++j)
      if (std::abs(ours[j] - ours[i] - interval_s) < std::abs(nearest - interval_s))
        nearest = ours[j] - ours[i];
  return nearest;
}

}  // namespace

Refusal different_taps(const std::string& name, const std::vector<double>& ours_s,
                       const std::vector<double>& theirs_s) {
  std::size_t strange = 0, first = 0;
  for (std::size_t i = 1; i < theirs_s.size(); ++i) {
    const double interval_s = theirs_s[i] - theirs_s[i - 1];
    if (std::abs(nearest_interval_s(ours_s, interval_s) - interval_s) <= kSameTap_s) continue;
    if (strange++ == 0) first = i;
  }
  if (strange == 0 || 2 * strange >= theirs_s.size() - 1)
    return {"taps_differ",
            fmt::format("{} has taps at other intervals: {:.3f} s from tap to tap, ours {:.3f} s (medians)",
                        name, median_interval_s(theirs_s), median_interval_s(ours_s)),
            "see that both recordings are of the same taps, and that t_s is in seconds"};
  const double interval_s = theirs_s[first] - theirs_s[first - 1];
  const double nearest_s = nearest_interval_s(ours_s, interval_s), missing_s = nearest_s - interval_s;
  return {
      "taps_differ",
      fmt::format("the taps of {} at {:.3f} and {:.3f} s are {:.3f} s apart, and no two of ours are: the "
                  "nearest are {:.3f} s apart ({:.3f} s {}, if these are the same taps)",
                  name, theirs_s[first - 1], theirs_s[first], interval_s, nearest_s, std::abs(missing_s),
                  missing_s > 0.0 ? "missing" : "too much"),
      "if that recorder lost rows there and its t_s counts rows, export its own times; if its clock was set, "
      "give the part before or after the step alone"};
}

}  // namespace sandhopper::calibrate
