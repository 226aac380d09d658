#include "tools/terrain/press_trial.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sandhopper {
namespace {

constexpr double kDefaultFrictionAngle_deg = 30.0;
constexpr double kRelieved_m = 5e-4;  // this far above the deepest point the plate counts as unloaded, or in
                                      // its own hole
constexpr std::size_t kMostPressSamples = 400;  // for one trial; more samples of a slow press add no
                                                // information

struct Row {
  double t_s, depth_m, force_N;
};

std::vector<Row> fresh_rows(const TrialRecording& recording) {
  const auto z = recording.channel("foot_z_m"), f = recording.channel("force_N");
  std::vector<Row> rows;
  for (std::size_t i = 0; i < recording.rows(); ++i)
    if (!std::isnan(z[i]) && !std::isnan(f[i]) && !recording.is_saturated("force_N", i))
      rows.push_back({recording.t_s[i], -z[i], f[i]});
  std::vector<Row> changed;
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (i == 0 || rows[i].force_N != rows[i - 1].force_N) changed.push_back(rows[i]);
  const bool held = 2 * changed.size() < rows.size();
  return held ? changed : rows;
}

// Interval in which the plate goes down: as stated in the set-up, or from the last time at the surface to the
// deepest point.
struct Window {
  double from_s, to_s;
};
Window loading_window(const CampaignTrial& trial, const std::vector<Row>& rows) {
  const auto deepest = std::max_element(rows.begin(), rows.end(),
                                        [](const Row& a, const Row& b) { return a.depth_m < b.depth_m; });
  auto first = deepest;
  while (first != rows.begin() && (first - 1)->depth_m > 0.0) --first;
  return {trial.number("loading_from_s").value_or(first->t_s),
          trial.number("loading_to_s").value_or(deepest->t_s)};
}

// True if inertia is significant. Then it is a stroke, whose force does not depend on depth alone
// (stroke_trials.hpp).
bool is_fast(const std::vector<Row>& loading) {
  constexpr double kInertial_mps = 0.0767;  // sqrt(2 d g) of 0.3 mm grains
  if (loading.size() < 2) return false;
  const double duration_s = loading.back().t_s - loading.front().t_s;
  return loading.back().depth_m - loading.front().depth_m > kInertial_mps * duration_s;
}

void keep_thinned(TrialSeries& series, const std::string& name, const std::vector<Row>& rows) {
  const std::size_t step = 1 + rows.size() / kMostPressSamples;
  for (std::size_t i = 0; i < rows.size(); i += step) {
    series[name + "_depth_m"].push_back(rows[i].depth_m);
    series[name + "_force_N"].push_back(rows[i].force_N);
  }
}

}  // namespace

void keep_press(const CampaignTrial& trial, const TrialRecording& recording, TrialResult& result) {
  if (!recording.has("foot_z_m") || !recording.has("force_N")) {
    result.ruled_out.push_back("force against depth: needs foot_z_m and force_N");
    return;
  }
  const bool on_stop = trial.kind == TrialKind::clamped;
  const auto rows = fresh_rows(recording);
  if (rows.size() < 10) {
    result.ruled_out.push_back("force against depth: fewer than ten rows with both");
    return;
  }
  const auto window = on_stop ? Window{rows.front().t_s, rows.back().t_s} : loading_window(trial, rows);
  std::vector<Row> loading, path;
  double deepest_m = 0.0;
  for (const auto& row : rows) {
    deepest_m = std::max(deepest_m, row.depth_m);  // includes earlier pushes, because a foot moves freely in
                                                   // its own hole
    if (row.t_s < window.from_s) continue;
    path.push_back(row);
    const bool relieved = row.depth_m < deepest_m - kRelieved_m;
    if (row.t_s <= window.to_s && row.depth_m > 0.0 && !relieved) loading.push_back(row);
  }
  if (!on_stop && recording.has_time && is_fast(loading)) return;
  keep_thinned(result.series, "press_path", path);
  if (!on_stop) keep_thinned(result.series, "press_loading", loading);
  const double diameter_m = 2.0 * std::get<IntruderBelief>(trial.belief).foot.radius_m;
  const double angle_deg = trial.number("friction_angle_deg").value_or(kDefaultFrictionAngle_deg);
  result.series["press"] = {on_stop ? 1.0 : 0.0, trial.flag("held_out").value_or(false) ? 1.0 : 0.0,
                            diameter_m, angle_deg * std::numbers::pi / 180.0};
}

bool holds_press(const TrialResult& result) {
  return result.series.contains("press") && result.series.contains("press_path_force_N");
}

PressTrial press_from(const TrialResult& result) {
  const auto& series = result.series;
  const auto& facts = series.at("press");
  PressTrial out{.trial = result.trial,
                 .on_stop = facts.at(0) > 0.0,
                 .held_out = facts.at(1) > 0.0,
                 .friction_angle_rad = facts.at(3),
                 .loading = {.diameter_m = facts.at(2), .samples = {}},
                 .path_displacement_m = series.at("press_path_depth_m"),
                 .path_force_N = series.at("press_path_force_N")};
  if (const auto depth = series.find("press_loading_depth_m"); depth != series.end())
    for (std::size_t i = 0; i < depth->second.size(); ++i)
      out.loading.samples.push_back({depth->second[i], series.at("press_loading_force_N")[i]});
  return out;
}

}  // namespace sandhopper
