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

// Derivatives of an angle that was sampled at irregular times: a cubic is fitted around every sample to those
// within half_width_s, with the weights (1 - |dt/half_width|^3)^3 (Cleveland's tricube). It uses samples up
// to half_width_s ahead, so it is for evaluation after the trial. Times [s] must strictly increase. NaN
// values are skipped and have NaN results. With fewer than six samples in the window the degree is reduced,
// down to a constant with zero derivatives.
std::vector<LocalDerivatives> local_polynomial(std::span<const double> t_s, std::span<const double> values,
                                               double half_width_s);

}  // namespace sandhopper
