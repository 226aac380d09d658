#pragma once
#include <array>
#include <span>
#include <vector>

#include "terrain/profile_config.hpp"

// Errors of the estimated depth in first strides, in the terms of strength_profile.hpp:
//   true depth - estimated depth = d + x(t) - x(0) + l (v - v_0) + rest
// t is the time since contact [s], v the speed [m/s], v_0 that at contact, x the error of the height filter.
namespace sandhopper {

struct DepthError {
  double since_contact_s;
  double change_mps;  // v - v_0
  double error_m;
};
using StrideDepthErrors = std::vector<DepthError>;

struct DepthErrorSpread {
  double surface_sd_m = 0.0;  // of d
  double filter_sd_m = 0.0;   // of x
  double lag_sd_s = 0.0;      // of l
  double rest_sd_m = 0.0;
};

// Maximum likelihood of the spreads, if all effects are normal with mean zero and independent, d and l are
// drawn once per stride, x has the correlation of strength_profile.hpp with this decay, and the rest is
// white. By the algorithm of Zhou, Hu, Qiao, Cho and Zhou 2019 (J. Comput. Graph. Stat. 28, 350). All are NaN
// without a stride of two errors.
DepthErrorSpread depth_error_spread(std::span<const StrideDepthErrors> strides,
                                    double decay_per_s = ProfileConfig{}.filter_decay_per_s);

}  // namespace sandhopper
