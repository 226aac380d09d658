#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "config/fields.hpp"

// Force of a bed against the depth of a round flat plate pressed in slowly: F = K A s(z; D, shape), with A
// the plate's area, D its diameter and at most one shape parameter. Each law determines the dependence on
// depth and on the plate's size. So a fit on one plate predicts another.
namespace sandhopper {

enum class DepthLaw : std::uint8_t {
  linear,            // s = z
  power,             // s = z (z / 1 cm)^(n - 1); shape n. The pressure at one depth does not depend on D
                     // (Bekker)
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
  double compliance_m_per_N = 0.0;     // of the plate's mounting: the plate is F x compliance less deep than
                                       // recorded
};

struct DepthLawFit {
  DepthLaw law{};
  double stiffness_per_area_N_per_m3 = 0.0;  // K
  double shape = 0.0;                        // exponent, cone factor, or floor depth [m]; 0 for linear
  double rms_N = 0.0;                        // root of the mean over trials of the mean squared residual
};

// Least squares in which every trial has the same weight, whatever its number of samples. The shape is
// searched over the range that is plausible for the depths fitted. Needs one trial with three samples;
// otherwise the result is NaN.
DepthLawFit fit_depth_law(DepthLaw law, std::span<const DepthTrial> trials, const DepthLawOptions& options);

// Force [N] at this recorded depth, i.e. before the compliance is subtracted. Infinite at or below the floor.
double depth_law_force_N(const DepthLawFit& fit, double depth_m, double diameter_m,
                         const DepthLawOptions& options);

double rms_residual_N(const DepthLawFit& fit, const DepthTrial& trial, const DepthLawOptions& options);

// Leave-one-trial-out cross-validation: rms residual [N] of each trial under the fit to the others.
std::vector<double> cross_validate(DepthLaw law, std::span<const DepthTrial> trials,
                                   const DepthLawOptions& options);

// Force at a depth by interpolation between the means of samples within +-window of it; NaN if the trial does
// not reach that depth.
double measured_force_N(const DepthTrial& trial, double depth_m, double window_m = 0.5e-3);

}  // namespace sandhopper
