#pragma once
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "tools/terrain/strength_curve.hpp"

// Strength of the ground over depth pooled over several trials, with the trial as the unit
// (terrain/pooled_value.hpp at every depth).
namespace sandhopper {

struct PooledDepth {
  double depth_m = 0.0;
  PooledValue force_N{};
  PooledValue tangent_N_per_m{};
  // Force divided by depth; intervals scale in the same way.
  double secant_N_per_m(double force_N) const { return force_N / depth_m; }
};

// Comparison of a curve with the band of one new trial, widened by the curve's own error: share of its depths
// inside the band, and distance from the mean.
struct CurveInBand {
  std::string trial{};
  std::size_t depths = 0, inside = 0;
  double force_ratio = 0.0;  // mean over these depths of the curve's force divided by the band's middle
  double half_width = 0.0;   // mean of the band's half width divided by its middle
  double share() const;
};

// Curves of one source and one size of foot.
struct CurveGroup {
  CurveSource source = CurveSource::firmware;
  double diameter_m = 0.0;
  std::vector<StrengthCurve> curves{};
  std::vector<PooledDepth> depths{};  // half a cell apart, at depths that at least one trial visited
  // Slope between the ends of each curve over the depths that all trials visited, as mean with Student's t.
  double slope_from_m = 0.0, slope_to_m = 0.0;
  PooledValue slope_N_per_m{};
  PooledValue line_N_per_m{};  // slope of the line of terrain/ground_summary.hpp
  PooledValue secant_20mm_N_per_m{};
  PooledValue exponent{};
  // Lower bound of force over depth if no trial reached a point of the curve: the lower 95 % limit of the
  // mean of the trials' bounds.
  double at_least_N_per_m = 0.0;
  std::vector<CurveInBand> left_out{};  // each trial compared with the band of the others; for 3 to 30 trials

  const PooledDepth* at(double depth_m) const;  // nearest point; null outside
  double deepest_all_m() const;                 // deepest point that every trial reached
};

// Groups in the order in which their curves first appear, without held-out curves.
std::vector<CurveGroup> pool_curves(std::span<const StrengthCurve> curves);

// Band of a group for another foot: every force is multiplied by `ratio` at its depth.
using DepthRatio = std::function<double(double depth_m)>;
std::vector<PooledDepth> scaled(const CurveGroup& group, const DepthRatio& ratio);

// Compares a curve with a band. NaN points and points with an infinite interval are ignored.
CurveInBand in_band(const StrengthCurve& curve, std::span<const PooledDepth> band);

}  // namespace sandhopper
