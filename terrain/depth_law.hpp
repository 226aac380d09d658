#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "config/fields.hpp"

// Force of a bed against the depth of a round flat plate pressed in slowly, F = K A s(z; D, shape), with A
// the plate's area, D its diameter and one shape parameter at most. Each law says how the force grows with
// depth and, by that, with the plate's size, so a fit on one plate predicts another.
namespace sandhopper {

enum class DepthLaw : std::uint8_t {
  linear,            // s = z
  power,             // s = z (z / 1 cm)^(n - 1); shape n. Pressure at one depth does not know D (Bekker)
  cone,              // s = z + c D (1 - exp(-z / 0.1 D)); shape c. A stagnant cone grows under the plate
                     // (Kang et al. 2018: linear with an intercept in proportion to D)
  floor_stiffening,  // s = z (1 + exp(-(H - z) / 0.25 D)); shape H, a floor at that depth (PHYSICS 1.1)
  confined_layer     // s = z m(x), x = K_p tan(phi) D / (H - z), m = 2 (e^x - x - 1) / x^2; shape H, the
                     // layer's thickness. Slab between two rough faces whose vertical stress is K_p =
                     // (1 + sin phi)/(1 - sin phi) times the radial: equilibrium d(sigma_r)/dr =
                     // -2 tan(phi) sigma_z / h gives sigma_z = sigma_z(R) exp(2 K_p tan(phi) (R - r)/h), and
                     // m is its mean over the plate (the friction hill of upsetting, for a frictional
                     // material)
};
template <>
struct EnumNames<DepthLaw> {
  static constexpr std::array<std::string_view, 5> value{"linear", "power", "cone", "floor_stiffening",
                                                         "confined_layer"};
};

struct DepthSample {
  double depth_m;
  double force_N;
};
struct DepthTrial {
  double diameter_m = 0.0;
  std::vector<DepthSample> samples;
};

struct DepthLawOptions {
  double friction_angle_rad = 0.5236;  // internal friction of the bed, for confined_layer
  double compliance_m_per_N = 0.0;     // of what carries the plate: it is F x compliance less deep
};

struct DepthLawFit {
  DepthLaw law{};
  double stiffness_per_area_N_per_m3 = 0.0;  // K
  double shape = 0.0;                        // exponent, cone factor, or floor depth [m]; 0 for linear
  double rms_N = 0.0;                        // root of the mean over trials of the mean square
};

// Least squares with every trial weighing the same, whatever its number of samples. The shape is searched
// over all that makes sense for the depths fitted. Needs one trial with three samples; otherwise NaN.
DepthLawFit fit_depth_law(DepthLaw law, std::span<const DepthTrial> trials, const DepthLawOptions& options);

// Force [N] at this depth, as recorded (before the compliance is taken off). Infinite at or below the floor.
double depth_law_force_N(const DepthLawFit& fit, double depth_m, double diameter_m,
                         const DepthLawOptions& options);

double rms_residual_N(const DepthLawFit& fit, const DepthTrial& trial, const DepthLawOptions& options);

// Leave-one-trial-out: rms [N] of each trial under the fit on the others.
std::vector<double> cross_validate(DepthLaw law, std::span<const DepthTrial> trials,
                                   const DepthLawOptions& options);

// Force at a depth by interpolation between the mean of samples within +-window of it; NaN where the trial
// does not reach.
double measured_force_N(const DepthTrial& trial, double depth_m, double window_m = 0.5e-3);

}  // namespace sandhopper
