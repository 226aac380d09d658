#pragma once
#include <cstddef>
#include <span>
#include <vector>

// Motion and forces of a body that falls through a fluid into a bed, determined from its specific force f =
// h'' + g alone (h height, v = -h' downward speed). In the fluid, with mass m, displaced volume V, frontal
// area A,
//   (m + C_m rho V) h'' = -(m - rho V) g + 1/2 rho A C_d v^2,  i.e.  v' = alpha g - kappa v^2,
//   alpha = (m - rho V)/(m + C_m rho V),  kappa = 1/2 rho A C_d/(m + C_m rho V).
// alpha and kappa can be found without the mass. The bed's force is known per moving mass m + C_m rho V = (m
// - rho V)/alpha:
//   r = h'' + alpha g - kappa v^2   [m/s^2],   R = (m - rho V)/alpha r   [N].
namespace sandhopper {

struct FallingMotion {
  std::vector<double> speed_mps;  // downwards
  std::size_t rest_row = 0;       // first row of the rest from which the integration starts
  double bias_mps2 = 0.0;         // added to f so that f equals rest_specific_force_mps2 at rest
};

// Integrates f back in time from the rest after the impact. There the speed is zero and the accelerometer's
// bias is known, and during the tenths of a second of the impact the bias causes no noticeable error.
// rest_row: first row from which f stays within its noise of its last value. rest_specific_force_mps2 is g
// cos(tilt).
FallingMotion speed_from_rest(std::span<const double> t_s, std::span<const double> specific_force_mps2,
                              double rest_specific_force_mps2, std::size_t rest_row);

// First row of the rest at the record's end: from there on the average over average_samples stays within
// tolerance_mps2 of the mean of the last rest_samples. Returns the number of rows if the record does not end
// at rest.
std::size_t find_rest(std::span<const double> specific_force_mps2, std::size_t average_samples,
                      std::size_t rest_samples, double tolerance_mps2);

// Row of the first contact with the bed: the last row before the peak of f at which the averaged f is less
// than `sigmas` standard deviations above a straight line. The line is fitted to the second half of
// `before_s`, an interval that ends before_s / 3 before the peak.
struct Touchdown {
  std::size_t row = 0;
  std::size_t peak_row = 0;
};
Touchdown find_touchdown(std::span<const double> t_s, std::span<const double> specific_force_mps2,
                         std::size_t average_samples, double before_s, double sigmas);

struct FluidFit {
  double alpha = 0.0;  // share of g with which a body starts to fall in the fluid
  double kappa_per_m = 0.0;
  double rms_mps2 = 0.0;
  double condition = 0.0;  // condition number of the two scaled regressors; if it is large the fall
                           // determines only one combination
  std::size_t samples = 0;
};
// Least squares of v' = alpha g - kappa v^2 over the rows of the fall. NaN for fewer than ten rows.
FluidFit fit_fluid(std::span<const double> speed_mps, std::span<const double> specific_force_mps2,
                   double gravity_mps2);

// Hydrodynamic coefficients for a given mass, which the fall itself cannot determine.
struct FluidBody {
  double mass_kg, volume_m3, frontal_area_m2, density_kg_per_m3;
};
struct FluidCoefficients {
  double moving_mass_kg;  // m + C_m rho V
  double added_mass_factor;
  double drag_coefficient;
};
FluidCoefficients coefficients(const FluidFit& fit, const FluidBody& body);

}  // namespace sandhopper
