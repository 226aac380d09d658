#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace sandhopper::calibrate {

// One quantity over time.
struct Series {
  std::vector<double> time_s;
  std::vector<double> value;

  std::size_t size() const { return value.size(); }
};

// Reason why measurements or a fit are rejected: `reason` for programs, `text` and `cure` for the user.
struct Refusal {
  std::string reason;  // "moving", "saturated", "too_few_points", ...
  std::string text;
  std::string cure;
};

// Mean of a quantity that should stand still. The standard error comes from the means of ten equal parts of
// the recording, because neighbouring samples may be correlated.
struct StillMean {
  double value = 0.0;
  double standard_error = 0.0;
  double noise = 0.0;   // standard deviation of one sample within a part
  double wander = 0.0;  // largest minus smallest mean of the parts
  std::size_t samples = 0;
  double duration_s = 0.0;
};

// Requirements of still_mean(). max_wander has the unit of the quantity.
struct StillLimits {
  std::size_t min_samples = 100;
  double min_duration_s = 0.5;
  double max_wander;  // allowed range of the means of the parts, beyond noise
};

// Appends to `refusals` if the quantity did not stand still: "too_few_samples", "stuck" (no noise), and for a
// range of the means beyond limit and noise "slipped" (one step explains it), "drifting" (a straight line
// explains it) or "moving". `what` names recording and quantity in the messages.
StillMean still_mean(const Series& series, const StillLimits& limits, const std::string& what,
                     std::vector<Refusal>& refusals);

}  // namespace sandhopper::calibrate
