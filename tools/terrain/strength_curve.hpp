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
  rig,        // a plate that a rig presses or drives into the ground
  drop        // a falling body's accelerometers
};
template <>
struct EnumNames<CurveSource> {
  static constexpr std::array<std::string_view, 4> value{"firmware", "load_cell", "rig", "drop"};
};

// Strength of the ground over depth from one trial, at the depths that it visited.
struct StrengthCurve {
  std::string trial{};
  CurveSource source = CurveSource::firmware;
  double diameter_m = 0.0;  // diameter of the foot
  bool held_out = false;
  double cell_m = kProfileCell_m;  // points are half a cell apart, tangents are for whole cells
  double from_m = 0.0, to_m = 0.0;
  double greatest_N = 0.0;                      // largest force of the ground
  double depth_sd_m = 0.0;                      // common error of all depths relative to the surface
  double shared_sd_relative = 0.0;              // relative error of every force that is common to all trials
                                                // of the campaign
  std::vector<double> force_N{}, force_sd_N{};  // at the depths (i + 1) cell_m / 2
  std::vector<double> tangent_N_per_m{}, tangent_sd_N_per_m{};  // in cell j
  TrialValue line_N_per_m{};  // slope of the line with a short intercept; NaN: too little ground
  TrialValue exponent{};      // exponent of a power law; NaN: too little ground
  GroundShape shape = GroundShape::unknown;

  // Lower bound of force over depth if the depth cannot be distinguished from zero: the largest force divided
  // by the upper 95 % limit of the deepest point.
  double at_least_N_per_m() const;
  // Interpolated between the points; NaN outside the visited depths.
  TrialValue force_at(double depth_m) const;
  TrialValue tangent_at(double depth_m) const;
};

// One sample of a loading; motion is positive downward.
struct LoadingSample {
  double t_s, depth_m, speed_mps, accel_mps2, force_N;
};

struct CurveFacts {
  CurveSource source = CurveSource::rig;
  double diameter_m = 0.0;
  bool held_out = false;
  double believed_stiffness_N_per_m = 0.0;  // if not positive, the trial's own mean slope is used
  double shared_sd_relative = 0.0;
  bool quasi_static = false;  // without added mass and drag
};

// Curve from samples at increasing depths, by terrain/strength_profile.hpp. If the depth exceeds the range of
// its cells, depth is counted in a larger unit: every length of the prior is scaled with it, and the cells
// become wider. The force is measured, so its scale is known. Fewer than ten samples give a curve without
// points.
StrengthCurve curve_of(std::span<const LoadingSample> loading, const CurveFacts& facts);

// Curve of a slow press from depth and force only.
StrengthCurve curve_of_press(std::span<const double> depth_m, std::span<const double> force_N,
                             const CurveFacts& facts);

// Curve after the strides of a hop. `greatest_N` is the largest force of the ground.
StrengthCurve curve_of(const ProfileSolver& solver, double greatest_N, const CurveFacts& facts);

// Stiffness of an intruder's bed under its foot; zero where the belief has none or nobody stated it.
double believed_stiffness_N_per_m(const CampaignTrial& trial);

// A curve is stored in its trial's series, one for each source.
void keep_curve(const StrengthCurve& curve, TrialResult& result);
std::vector<StrengthCurve> curves_of(const TrialResult& result);

}  // namespace sandhopper
