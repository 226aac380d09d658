#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace sandhopper::calibrate {

// One figure over time.
struct Series {
  std::vector<double> time_s;
  std::vector<double> value;

  std::size_t size() const { return value.size(); }
};

// Why a set of measurements, or a fit, is not believed: one word for programs, a sentence, what to do.
struct Refusal {
  std::string reason;  // "moving", "saturated", "too_few_points", ...
  std::string text;
  std::string cure;
};

// Mean of a figure that ought to stand still. The standard error is that of the means of ten equal stretches,
// so that noise which is correlated from sample to sample is not taken for more knowledge than it is.
struct StillMean {
  double value = 0.0;
  double standard_error = 0.0;
  double noise = 0.0;   // standard deviation of one sample within a stretch
  double wander = 0.0;  // largest minus smallest mean of a stretch
  std::size_t samples = 0;
  double duration_s = 0.0;
};

struct StillLimits {
  std::size_t min_samples = 100;
  double min_duration_s = 0.5;
  double max_wander;  // between stretches, beyond what noise explains
};

// Sets `refusals` where the figure did not stand still: "too_few_samples", "stuck", and of wander beyond
// limits and noise "slipped" (one step explains it), "drifting" (a straight line does) or "moving". `what`
// names the recording and the figure in the sentences.
StillMean still_mean(const Series& series, const StillLimits& limits, const std::string& what,
                     std::vector<Refusal>& refusals);

}  // namespace sandhopper::calibrate
