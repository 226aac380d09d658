#include "tools/terrain/strength_curve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "terrain/none.hpp"

namespace sandhopper {
namespace {

constexpr std::size_t kFewestLoadingSamples = 10;

// Converts the configuration to depths in units of `unit` metres: lengths and speeds of the prior become
// smaller, stiffnesses larger. The added mass is proportional to the cube of a length and multiplies an
// acceleration; drag is proportional to an area and the square of a speed.
StiffnessConfig in_units(StiffnessConfig config, double unit) {
  const double mass = std::pow(unit, 4);
  ProfileConfig profile = config.profile_or_default();
  profile.believed_stiffness_N_per_m *= unit;
  profile.steady_drag_sd *= mass;
  for (double* length :
       {&profile.depth_noise_m, &profile.surface_sd_m, &profile.shared_surface_sd_m, &profile.filter_sd_m})
    *length /= unit;
  config.profile = profile;
  auto& joint = config.joint;
  for (double* length : {&joint.fluctuation_length_m, &joint.intercept_growth_depth_m,
                         &joint.intercept_depth_m, &joint.intercept_depth_sd_m, &joint.surface_sd_m,
                         &joint.depth_drift_sd_mps, &config.min_depth_span_m})
    *length /= unit;
  joint.added_mass_factor *= mass;
  joint.added_mass_factor_sd *= mass;
  return config;
}

// Smallest power of two for which the cells cover the depth.
double unit_for(double deepest_m) {
  double unit = 1.0;
  while (deepest_m >= unit * kProfileDepth_m) unit *= 2.0;
  return unit;
}

StiffnessConfig config_for(std::span<const LoadingSample> loading, const CurveFacts& facts) {
  StiffnessConfig config;
  // Errors of a press's depth. It is measured, so it has no error of a filter that integrates accelerations,
  // and none of a contact that is detected late.
  ProfileConfig profile{.surface_sd_m = 0.0007,
                        .shared_surface_sd_m = 0.0,
                        .filter_sd_m = 1e-9,
                        .depth_lag_s = 0.0,
                        .depth_lag_sd_s = 0.0005,
                        .depth_noise_m = 0.0003};
  const auto& last = loading.back();
  const double mean_slope = last.force_N / last.depth_m;
  profile.believed_stiffness_N_per_m =
      facts.believed_stiffness_N_per_m > 0.0 ? facts.believed_stiffness_N_per_m : std::max(mean_slope, 1.0);
  if (facts.quasi_static) profile.steady_drag_sd = 1e-6;
  config.profile = profile;
  config.max_depth_m = std::numeric_limits<double>::infinity();             // the foot is carried by a rod
  config.joint.accel_range_mps2 = std::numeric_limits<double>::infinity();  // the caller removed saturated
                                                                            // samples
  config.joint.depth_drift_sd_mps = 1e-6;
  if (facts.quasi_static) {
    config.joint.added_mass_factor = 0.0;
    config.joint.added_mass_factor_sd = 1e-6;
  }
  return config;
}

// Points of the curve at the depths visited, converted back to metres.
StrengthCurve points_of(const ProfileSolver& solver, const GroundSummary& summary, double unit,
                        double greatest_N, const CurveFacts& facts) {
  const auto& joint = solver.config().joint;
  const double noise_m = solver.config().profile_or_default().depth_noise_m;
  const StrengthProfile& p = solver.profile();
  StrengthCurve curve{.source = facts.source,
                      .diameter_m = facts.diameter_m,
                      .held_out = facts.held_out,
                      .cell_m = unit * kProfileCell_m,
                      .from_m = unit * p.depth_min_m,
                      .to_m = unit * p.depth_max_m,
                      .greatest_N = greatest_N,
                      .depth_sd_m = unit * std::hypot(joint.surface_sd_m, noise_m),
                      .shared_sd_relative = facts.shared_sd_relative,
                      .line_N_per_m = {kNone, kNone},
                      .exponent = {kNone, kNone},
                      .shape = summary.shape};
  for (std::size_t i = 0; i < kProfilePoints && (static_cast<double>(i)) * kProfilePoint_m < p.depth_max_m;
       ++i) {
    curve.force_N.push_back(p.force_N[i]);
    curve.force_sd_N.push_back(p.force_sd_N[i]);
  }
  for (std::size_t j = 0; j < kProfileCells && static_cast<double>(j) * kProfileCell_m < p.depth_max_m; ++j) {
    curve.tangent_N_per_m.push_back(p.tangent_N_per_m[j] / unit);
    curve.tangent_sd_N_per_m.push_back(p.tangent_sd_N_per_m[j] / unit);
  }
  constexpr double kWidth = 2.0 * 1.959964;
  const auto value = [&](const SummaryValue& s, double scale) {
    return TrialValue{scale * s.value, scale * (s.ci95_high - s.ci95_low) / kWidth};
  };
  if (summary.shape != GroundShape::unknown) {
    curve.line_N_per_m = value(summary.line_N_per_m, 1.0 / unit);
    curve.exponent = value(summary.exponent, 1.0);
  }
  return curve;
}

std::string series_name(CurveSource source, std::string_view what) {
  return fmt::format("profile_{}{}{}", name_of(source), what.empty() ? "" : "_", what);
}

}  // namespace

double StrengthCurve::at_least_N_per_m() const {
  constexpr double kNormal975 = 1.959964;
  return greatest_N / (to_m + kNormal975 * depth_sd_m);
}

TrialValue StrengthCurve::force_at(double depth_m) const {
  if (!(depth_m >= from_m && depth_m <= to_m)) return {kNone, kNone};
  const double place = depth_m / (0.5 * cell_m);
  const auto i = static_cast<std::size_t>(place);
  if (i > force_N.size()) return {kNone, kNone};
  const double share = place - static_cast<double>(i);
  const auto at = [&](const std::vector<double>& values) {
    const double above = i > 0 ? values[i - 1] : 0.0;
    return i < values.size() ? above + share * (values[i] - above) : above;  // exactly at the last point
  };
  return {at(force_N), at(force_sd_N)};
}

TrialValue StrengthCurve::tangent_at(double depth_m) const {
  if (!(depth_m >= from_m && depth_m <= to_m)) return {kNone, kNone};
  const auto j = static_cast<std::size_t>(depth_m / cell_m);
  if (j >= tangent_N_per_m.size()) return {kNone, kNone};
  return {tangent_N_per_m[j], tangent_sd_N_per_m[j]};
}

StrengthCurve curve_of(std::span<const LoadingSample> loading, const CurveFacts& facts) {
  std::vector<LoadingSample> samples;
  for (const auto& s : loading)
    if (s.depth_m > 0.0 && (samples.empty() || s.depth_m > samples.back().depth_m)) samples.push_back(s);
  if (samples.size() < kFewestLoadingSamples)
    return {.source = facts.source, .diameter_m = facts.diameter_m, .held_out = facts.held_out};
  const double unit = unit_for(samples.back().depth_m);
  const StiffnessConfig config = in_units(config_for(samples, facts), unit);
  // The force is measured independently of the acceleration, which corresponds to an infinite mass.
  ProfileRegression regression(config, 0.5 * facts.diameter_m / unit,
                               std::numeric_limits<double>::infinity());
  double before_s = samples.front().t_s;
  for (const auto& s : samples) {
    regression.add({.depth_m = s.depth_m / unit,
                    .speed_mps = s.speed_mps / unit,
                    .accel_mps2 = s.accel_mps2 / unit,
                    .force_N = s.force_N,
                    .leg_rate_mps = 0.0,
                    .since_contact_s = s.t_s - samples.front().t_s,
                    .duration_s = s.t_s - before_s},
                   0.0);
    before_s = s.t_s;
  }
  ProfileSolver solver(config);
  solver.add(regression.sums(), 1);
  const double greatest_N = std::ranges::max(samples, {}, &LoadingSample::force_N).force_N;
  return points_of(solver, summarise(solver), unit, greatest_N, facts);
}

StrengthCurve curve_of_press(std::span<const double> depth_m, std::span<const double> force_N,
                             const CurveFacts& facts) {
  constexpr double kSpeed_mps = 0.001;  // small enough that the lag between force and depth has no effect
  std::vector<LoadingSample> samples;
  for (std::size_t i = 0; i < depth_m.size(); ++i)
    samples.push_back({depth_m[i] / kSpeed_mps, depth_m[i], kSpeed_mps, 0.0, force_N[i]});
  CurveFacts slow = facts;
  slow.quasi_static = true;
  return curve_of(samples, slow);
}

StrengthCurve curve_of(const ProfileSolver& solver, double greatest_N, const CurveFacts& facts) {
  return points_of(solver, summarise(solver), 1.0, greatest_N, facts);
}

double believed_stiffness_N_per_m(const CampaignTrial& trial) {
  const auto& belief = std::get<IntruderBelief>(trial.belief);
  const double radius_m = belief.foot.radius_m;
  const double per_area = belief.terrain.stiffness_per_area_N_per_m3;
  if (per_area > 0.0) return per_area * std::numbers::pi * radius_m * radius_m;
  return trial.is_unstated("terrain.stiffness_N_per_m") ? 0.0 : belief.terrain.stiffness_N_per_m;
}

void keep_curve(const StrengthCurve& curve, TrialResult& result) {
  if (curve.force_N.empty() && curve.greatest_N <= 0.0) return;
  const auto keep = [&](std::string_view what, std::vector<double> values) {
    result.series[series_name(curve.source, what)] = std::move(values);
  };
  keep("",
       {curve.greatest_N, curve.depth_sd_m, curve.diameter_m, curve.held_out ? 1.0 : 0.0, curve.cell_m,
        curve.from_m, curve.to_m, curve.shared_sd_relative, curve.line_N_per_m.value, curve.line_N_per_m.sd,
        curve.exponent.value, curve.exponent.sd, static_cast<double>(curve.shape)});
  keep("force_N", curve.force_N);
  keep("force_sd_N", curve.force_sd_N);
  keep("tangent_N_per_m", curve.tangent_N_per_m);
  keep("tangent_sd_N_per_m", curve.tangent_sd_N_per_m);
}

std::vector<StrengthCurve> curves_of(const TrialResult& result) {
  std::vector<StrengthCurve> curves;
  for (std::size_t i = 0; i < EnumNames<CurveSource>::value.size(); ++i) {
    const auto source = static_cast<CurveSource>(i);
    const auto facts = result.series.find(series_name(source, ""));
    if (facts == result.series.end()) continue;
    const auto& n = facts->second;
    const auto of = [&](std::string_view what) { return result.series.at(series_name(source, what)); };
    curves.push_back({.trial = result.trial,
                      .source = source,
                      .diameter_m = n.at(2),
                      .held_out = n.at(3) > 0.0,
                      .cell_m = n.at(4),
                      .from_m = n.at(5),
                      .to_m = n.at(6),
                      .greatest_N = n.at(0),
                      .depth_sd_m = n.at(1),
                      .shared_sd_relative = n.at(7),
                      .force_N = of("force_N"),
                      .force_sd_N = of("force_sd_N"),
                      .tangent_N_per_m = of("tangent_N_per_m"),
                      .tangent_sd_N_per_m = of("tangent_sd_N_per_m"),
                      .line_N_per_m = {n.at(8), n.at(9)},
                      .exponent = {n.at(10), n.at(11)},
                      .shape = static_cast<GroundShape>(n.at(12))});
  }
  return curves;
}

}  // namespace sandhopper
