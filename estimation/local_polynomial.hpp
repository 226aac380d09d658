#pragma once
#include <span>
#include <vector>

namespace sandhopper {

// Value and time derivatives of a signal at the instant of one of its samples.
struct LocalDerivatives {
  double value;
  double rate;
  double acceleration;
};

// Cubic fitted around every sample to those within half_width_s, weighted with (1 - |dt/half_width|^3)^3
// (Cleveland's tricube): derivatives of an angle that was sampled at irregular times. It looks ahead by
// half_width_s, so it is for work after the trial. Times [s] grow strictly, NaN values are left out and have
// NaN results; where a gap leaves fewer than six samples the degree falls, down to a constant with zero
// derivatives.
std::vector<LocalDerivatives> local_polynomial(std::span<const double> t_s, std::span<const double> values,
                                               double half_width_s);

}  // namespace sandhopper
