#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "terrain/ground_summary.hpp"
#include "terrain/pooled_value.hpp"
#include "tools/campaign/campaign.hpp"
#include "tools/terrain/trial_result.hpp"

namespace sandhopper {

// Source of a curve's force and depth.
enum class CurveSource : std::uint8_t {
  firmware,   // a hop through the firmware's own estimators
  load_cell,  // a hop's load cell and motion capture
  rig,        // a plate that a rig presses or drives in
  drop        // a falling body's accelerometers
};
template <>
struct EnumNames<CurveSource> {
  static constexpr std::array<std::string_view, 4> value{"firmware", "load_cell", "rig", "drop"};
};

// Strength of the ground over depth as one trial shows it, at the depths that it visited.
struct StrengthCurve {
  std::string trial{};
  CurveSource source = CurveSource::firmware;
  double diameter_m = 0.0;  // of the foot
  bool held_out = false;
  double cell_m = kProfileCell_m;  // points are half a cell apart, tangents belong to whole cells
  double from_m = 0.0, to_m = 0.0;
  double greatest_N = 0.0;                      // force that the ground bore
  double depth_sd_m = 0.0;                      // of the depths as a whole, against the surface
  double shared_sd_relative = 0.0;              // error of every force that all trials of the campaign share
  std::vector<double> force_N{}, force_sd_N{};  // at (i + 1) cell_m / 2
  std::vector<double> tangent_N_per_m{}, tangent_sd_N_per_m{};  // in cell j
  TrialValue line_N_per_m{};  // slope of the line with a short intercept; NaN: too little ground
  TrialValue exponent{};      // of a power law; likewise
  GroundShape shape = GroundShape::unknown;

  // Force over depth that the ground has at least, where no depth can be told from none: the greatest force
  // over the deepest point's upper 95 % limit.
  double at_least_N_per_m() const;
  // Between the points; NaN where the trial was not.
  TrialValue force_at(double depth_m) const;
  TrialValue tangent_at(double depth_m) const;
};

// One sample of a loading: motion downward.
struct LoadingSample {
  double t_s, depth_m, speed_mps, accel_mps2, force_N;
};

struct CurveFacts {
  CurveSource source = CurveSource::rig;
  double diameter_m = 0.0;
  bool held_out = false;
  double believed_stiffness_N_per_m = 0.0;  // not positive: the trial's own mean slope
  double shared_sd_relative = 0.0;
  bool quasi_static = false;  // neither added mass nor drag
};

// The curve of samples at ever new depths, by terrain/strength_profile.hpp. Deeper than its cells reach,
// depth is counted in a larger unit: every length of the prior is scaled with it, the cells are wider. The
// force is measured: its scale is no unknown. Fewer than ten samples give a curve without points.
StrengthCurve curve_of(std::span<const LoadingSample> loading, const CurveFacts& facts);

// A slow press, of which only depth and force count.
StrengthCurve curve_of_press(std::span<const double> depth_m, std::span<const double> force_N,
                             const CurveFacts& facts);

// After the strides of a hop; `greatest_N`: the force that the ground bore.
StrengthCurve curve_of(const ProfileSolver& solver, double greatest_N, const CurveFacts& facts);

// Stiffness of an intruder's bed under its foot; zero where the belief has none or nobody stated it.
double believed_stiffness_N_per_m(const CampaignTrial& trial);

// A curve travels in its trial's series, one for each source.
void keep_curve(const StrengthCurve& curve, TrialResult& result);
std::vector<StrengthCurve> curves_of(const TrialResult& result);

}  // namespace sandhopper
