#pragma once
#include <array>
#include <span>
#include <vector>

// Errors of the estimated depth in first strides, in the terms of strength_profile.hpp:
//   true depth - estimated depth = d + r t + l (v - v_0) + rest
// t is the time since contact [s], v the speed [m/s], v_0 that at contact.
namespace sandhopper {

struct DepthError {
  double since_contact_s;
  double change_mps;  // v - v_0
  double error_m;
};
using StrideDepthErrors = std::vector<DepthError>;

struct DepthErrorSpread {
  double surface_sd_m = 0.0;  // of d
  double drift_sd_mps = 0.0;  // of r
  double lag_sd_s = 0.0;      // of l
  double rest_sd_m = 0.0;
};

// Maximum likelihood of the spreads, if d, r and l are normal with mean zero, independent and drawn once per
// stride, and the rest is white, by expectation maximisation (Laird & Ware 1982, Biometrics 38, 963). All are
// NaN without a stride of two errors.
DepthErrorSpread depth_error_spread(std::span<const StrideDepthErrors> strides);

}  // namespace sandhopper
