#pragma once
#include <array>
#include <span>
#include <vector>

#include "terrain/trial_statistics.hpp"

// Splits the force of a foot driven into the ground into parts due to depth, speed and acceleration:
//   F = F0 + k z + (a + b z + c z^2) v^2                          map of depth and speed
//     + (a z + b z^2/2 + c z^3/3) zdd                             added mass; its gradient is the drag
// with z depth, v speed and zdd acceleration, all downward, for samples at new depths. It is solved from sums
// over trials, so that thousands fit in memory. Intervals are jackknife intervals (leave one trial out).
namespace sandhopper {

struct StrokeSample {
  double depth_m;
  double speed_mps;   // downward
  double accel_mps2;  // downward; 0 if it is unknown
  double force_N;
};

// Products of the regressors 1, z, v^2, z v^2, z^2 v^2, z zdd, z^2 zdd/2, z^3 zdd/3 and F over one trial.
class StrokeSums {
 public:
  static constexpr std::size_t kRegressors = 8;
  static constexpr std::size_t kColumns = kRegressors + 1;

  void add(const StrokeSample& sample);
  void add(const StrokeSums& other);
  double samples() const { return at(0, 0); }
  double at(std::size_t row, std::size_t column) const;

  // Upper triangle, row by row, for storage in a trial's result.
  std::vector<double> numbers() const { return {products_.begin(), products_.end()}; }
  static StrokeSums from(std::span<const double> numbers);  // zeros if the size does not match

 private:
  std::array<double, kColumns*(kColumns + 1) / 2> products_{};
};

struct StrokeMap {
  double intercept_N = 0.0;                  // F0
  double stiffness_N_per_m = 0.0;            // k
  std::array<double, 3> drag_coefficient{};  // a [kg/m], b [kg/m^2], c [kg/m^3]

  double drag_kg_per_m(double depth_m) const;
  double added_mass_kg(double depth_m) const;
};

enum class StrokeTerms { depth_and_speed, with_added_mass };
// Least squares over all samples in `sums`. NaN if the terms are not determined (a single speed, too few
// samples).
StrokeMap fit_stroke_map(const StrokeSums& sums, StrokeTerms terms);

// Residuals of a trial's force for each description.
struct StrokeResiduals {
  double line_rms_N = 0.0;  // straight line fitted to this trial alone
  double map_rms_N = 0.0;
  double added_mass_rms_N = 0.0;  // map and added mass, not fitted to the trial
  double correlation = 0.0;       // between the map's residual and the added-mass force
};
StrokeResiduals stroke_residuals(const StrokeSums& trial, const StrokeMap& map);

// Map over all trials; each coefficient has a jackknife interval with the trial as the unit.
struct StrokeMapWithIntervals {
  StrokeMap map;
  TrialMean intercept_N, stiffness_N_per_m, drag_at_surface_kg_per_m, added_mass_at_30mm_kg;
};
StrokeMapWithIntervals fit_stroke_map(std::span<const StrokeSums> trials, StrokeTerms terms);

}  // namespace sandhopper
