#pragma once
#include <cstddef>
#include <span>

// Statistics with the trial as the unit. Samples of one trial share its bed, zero and noise, so an interval
// counts trials, not samples.
namespace sandhopper {

// Mean over trials of one value per trial, with the 95 % interval of Student's t with n - 1 degrees of
// freedom. With one trial the limits are infinite.
struct TrialMean {
  double value = 0.0;
  double ci95_low = 0.0;
  double ci95_high = 0.0;
  double standard_deviation = 0.0;  // standard deviation between trials
  std::size_t trials = 0;

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("value", self.value);
    visit("ci95_low", self.ci95_low);
    visit("ci95_high", self.ci95_high);
  }
};

// NaN values are ignored. Without any value the result is NaN.
TrialMean mean_over_trials(std::span<const double> per_trial);

// Two-sided 95 % critical value of Student's t: 12.706, 4.303, 3.182, ... 1.960.
double student_t95(std::size_t degrees_of_freedom);

// 2.5 and 97.5 percentiles of bootstrap replicates. Each replicate is made from trials drawn with
// replacement.
struct PercentileInterval {
  double ci95_low;
  double ci95_high;
};
PercentileInterval percentile_interval(std::span<const double> replicates);

}  // namespace sandhopper
