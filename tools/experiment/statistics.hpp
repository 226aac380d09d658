#pragma once
#include <span>
#include <vector>

// Statistics of small samples for the experiments. Without values they are NaN, except standard_deviation().
namespace sandhopper {

double mean(std::span<const double> values);
double standard_deviation(std::span<const double> values);  // sample standard deviation with n - 1; 0 for
                                                            // fewer than two values
double rms(std::span<const double> values);
double correlation(std::span<const double> a, std::span<const double> b);
double largest(std::span<const double> values);
double smallest(std::span<const double> values);
double median(std::span<const double> values);  // the upper middle value for an even number

// y = intercept + slope x by ordinary least squares.
struct LineFit {
  double intercept = 0.0;
  double slope = 0.0;
  double r_squared = 0.0;
  double rms = 0.0;  // of the residuals
};
LineFit fit_line(std::span<const double> x, std::span<const double> y);

}  // namespace sandhopper
