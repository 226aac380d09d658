#include "terrain/depth_law.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "terrain/none.hpp"

namespace sandhopper {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Mean stress of the confined layer over the plate, relative to the stress at the rim.
double friction_hill(double x) {
  if (x < 1e-3) return 1.0 + x / 3.0;
  return 2.0 * (std::expm1(x) - x) / (x * x);
}

// s(z; D, shape) [m]
double shape_m(DepthLaw law, double shape, double depth_m, double diameter_m, double confinement) {
  const double z = std::max(depth_m, 0.0);
  switch (law) {
    case DepthLaw::linear:
      return z;
    case DepthLaw::power:
      return 0.01 * std::pow(z / 0.01, shape);
    case DepthLaw::cone:
      return z - shape * diameter_m * std::expm1(-z / (0.1 * diameter_m));
    case DepthLaw::floor_stiffening:
      return z * (1.0 + std::exp(-(shape - z) / (0.25 * diameter_m)));
    case DepthLaw::confined_layer:
      return z < shape ? z * friction_hill(std::min(confinement * diameter_m / (shape - z), 300.0))
                       : kInfinity;
  }
  return kNone;
}

double confinement_of(const DepthLawOptions& options) {
  const double s = std::sin(options.friction_angle_rad);
  return (1.0 + s) / (1.0 - s) * std::tan(options.friction_angle_rad);
}

double area_m2(double diameter_m) { return std::numbers::pi * diameter_m * diameter_m / 4.0; }

// Best K for a given shape.
DepthLawFit at_shape(DepthLaw law, double shape, std::span<const DepthTrial> trials,
                     const DepthLawOptions& options) {
  const double confinement = confinement_of(options);
  double ss = 0.0, sf = 0.0, ff = 0.0, count = 0.0;
  for (const auto& trial : trials) {
    if (trial.samples.empty()) continue;
    const double weight = 1.0 / static_cast<double>(trial.samples.size());
    count += 1.0;
    for (const auto& sample : trial.samples) {
      const double depth_m = sample.depth_m - options.compliance_m_per_N * sample.force_N;
      const double s =
          area_m2(trial.diameter_m) * shape_m(law, shape, depth_m, trial.diameter_m, confinement);
      ss += weight * s * s;
      sf += weight * s * sample.force_N;
      ff += weight * sample.force_N * sample.force_N;
    }
  }
  if (!(ss > 0.0) || std::isinf(ss)) return {law, kNone, shape, kInfinity};
  return {law, sf / ss, shape, std::sqrt(std::max(ff - sf * sf / ss, 0.0) / count)};
}

struct Bracket {
  double low, high;
};

// Search range of the shape for this depth of the samples.
Bracket shapes(DepthLaw law, double deepest_m) {
  switch (law) {
    case DepthLaw::power:
      return {0.3, 4.0};
    case DepthLaw::cone:
      return {1e-4, 3.0};
    case DepthLaw::floor_stiffening:
      return {0.3 * deepest_m, 30.0 * deepest_m};
    case DepthLaw::confined_layer:
      return {1.02 * deepest_m, 100.0 * deepest_m};
    case DepthLaw::linear:
      break;
  }
  return {0.0, 0.0};
}

DepthLawFit search(DepthLaw law, Bracket bracket, std::span<const DepthTrial> trials,
                   const DepthLawOptions& options) {
  constexpr int kSteps = 60;
  DepthLawFit best{law, kNone, kNone, kInfinity};
  double ratio = std::pow(bracket.high / bracket.low, 1.0 / kSteps);
  double centre = std::sqrt(bracket.low * bracket.high);
  for (int round = 0; round < 6; ++round) {
    const int half = round == 0 ? kSteps / 2 : 10;
    for (int i = -half; i <= half; ++i) {
      const double shape = std::clamp(centre * std::pow(ratio, i), bracket.low, bracket.high);
      const auto fit = at_shape(law, shape, trials, options);
      if (fit.rms_N < best.rms_N) best = fit;
    }
    if (std::isinf(best.rms_N)) return best;
    centre = best.shape;
    ratio = std::pow(ratio, 0.15);
  }
  return best;
}

}  // namespace

DepthLawFit fit_depth_law(DepthLaw law, std::span<const DepthTrial> trials, const DepthLawOptions& options) {
  double deepest_m = 0.0;
  std::size_t most = 0;
  for (const auto& trial : trials) {
    most = std::max(most, trial.samples.size());
    for (const auto& sample : trial.samples) deepest_m = std::max(deepest_m, sample.depth_m);
  }
  if (most < 3 || !(deepest_m > 0.0)) return {law, kNone, kNone, kNone};
  if (law == DepthLaw::linear) return at_shape(law, 0.0, trials, options);
  return search(law, shapes(law, deepest_m), trials, options);
}

double depth_law_force_N(const DepthLawFit& fit, double depth_m, double diameter_m,
                         const DepthLawOptions& options) {
  const double confinement = confinement_of(options);
  const double scale_N_per_m = fit.stiffness_per_area_N_per_m3 * area_m2(diameter_m);
  const auto at = [&](double true_depth_m) {
    return scale_N_per_m * shape_m(fit.law, fit.shape, true_depth_m, diameter_m, confinement);
  };
  if (options.compliance_m_per_N <= 0.0 || depth_m <= 0.0) return at(depth_m);
  double low_m = 0.0, high_m = depth_m;  // the recorded depth (true depth + compliance x force) increases
                                         // with the true depth
  for (int i = 0; i < 60; ++i) {
    const double middle_m = 0.5 * (low_m + high_m);
    (middle_m + options.compliance_m_per_N * at(middle_m) > depth_m ? high_m : low_m) = middle_m;
  }
  return at(low_m);
}

double rms_residual_N(const DepthLawFit& fit, const DepthTrial& trial, const DepthLawOptions& options) {
  double squares = 0.0;
  for (const auto& sample : trial.samples) {
    const double error = depth_law_force_N(fit, sample.depth_m, trial.diameter_m, options) - sample.force_N;
    squares += error * error;
  }
  return trial.samples.empty() ? kNone : std::sqrt(squares / static_cast<double>(trial.samples.size()));
}

std::vector<double> cross_validate(DepthLaw law, std::span<const DepthTrial> trials,
                                   const DepthLawOptions& options) {
  std::vector<double> out;
  for (std::size_t left_out = 0; left_out < trials.size(); ++left_out) {
    std::vector<DepthTrial> rest(trials.begin(), trials.end());
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(left_out));
    out.push_back(rms_residual_N(fit_depth_law(law, rest, options), trials[left_out], options));
  }
  return out;
}

double measured_force_N(const DepthTrial& trial, double depth_m, double window_m) {
  double below_z = 0.0, below_f = 0.0, above_z = 0.0, above_f = 0.0;
  std::size_t below = 0, above = 0;
  for (double reach_m = window_m; reach_m <= 4.0 * window_m && (below == 0 || above == 0); reach_m *= 2.0) {
    below_z = below_f = above_z = above_f = 0.0;
    below = above = 0;
    for (const auto& sample : trial.samples) {
      if (std::abs(sample.depth_m - depth_m) > reach_m) continue;
      const bool deeper = sample.depth_m > depth_m;
      (deeper ? above_z : below_z) += sample.depth_m;
      (deeper ? above_f : below_f) += sample.force_N;
      ++(deeper ? above : below);
    }
  }
  if (below == 0 || above == 0) return kNone;
  const double z0 = below_z / static_cast<double>(below), z1 = above_z / static_cast<double>(above);
  const double f0 = below_f / static_cast<double>(below), f1 = above_f / static_cast<double>(above);
  return f0 + (f1 - f0) * (depth_m - z0) / (z1 - z0);
}

}  // namespace sandhopper
