#include "tools/terrain/press_trials.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/campaign/read_table.hpp"
#include "tools/campaign/surface_check.hpp"
#include "tools/terrain/strength_curve.hpp"

namespace sandhopper {
namespace {

// Above this speed the bed also responds to speed, and a depth law alone is not valid: sqrt(2 d g) of 0.3 mm
// grains (Goldman & Umbanhowar).
constexpr double kSlow_mps = 0.077;

bool slow(const TrialRecording& recording) {
  const auto* depth = recording.find("foot_z_m");
  if (depth == nullptr || !recording.has_time) return true;
  double first_t = std::nan(""), last_t = 0.0, low = INFINITY, high = -INFINITY;
  for (std::size_t i = 0; i < recording.rows(); ++i) {
    if (std::isnan((*depth)[i])) continue;
    if (std::isnan(first_t)) first_t = recording.t_s[i];
    last_t = recording.t_s[i];
    low = std::min(low, (*depth)[i]);
    high = std::max(high, (*depth)[i]);
  }
  return !(last_t > first_t) || (high - low) / (last_t - first_t) < kSlow_mps;
}

// A force above the surface that nobody confirmed; 0: none.
double untared_force_of(const CampaignTrial& trial, const TrialRecording& recording) {
  const auto* mapping = mapping_of(trial, "force_N");
  const bool is_stated = mapping != nullptr && mapping->is_stated();
  if (is_stated || !recording.has("force_N") || !recording.has("foot_z_m")) return 0.0;
  return trial.kind == TrialKind::clamped ? 0.0 : untared_force_N(recording);
}

}  // namespace

bool PressTrials::takes(CampaignPlant plant, TrialKind kind) const {
  return plant == CampaignPlant::intruder &&
         (kind == TrialKind::intrusion || kind == TrialKind::press || kind == TrialKind::clamped);
}

void PressTrials::analyse(const CampaignTrial& trial, const TrialRecording& recording,
                          TrialResult& result) const {
  if (!slow(recording)) return;
  if (const double force_N = untared_force_of(trial, recording); force_N != 0.0) {
    result.ruled_out.push_back(fmt::format(
        "force against depth: force_N reads {:.3g} N above the surface, and every law would hold it; "
        "tare it, or state unit and scale of force_N if it is so",
        force_N));
    return;
  }
  keep_press(trial, recording, result);
  if (!holds_press(result) || trial.kind == TrialKind::clamped) return;
  const auto depth = result.series.find("press_loading_depth_m");
  if (depth == result.series.end()) return;
  const auto& belief = std::get<IntruderBelief>(trial.belief);
  keep_curve(curve_of_press(depth->second, result.series.at("press_loading_force_N"),
                            {.source = CurveSource::rig,
                             .diameter_m = 2.0 * belief.foot.radius_m,
                             .held_out = trial.flag("held_out").value_or(false),
                             .believed_stiffness_N_per_m = believed_stiffness_N_per_m(trial)}),
             result);
}

CampaignConclusions PressTrials::conclude(std::span<const TrialResult* const> results) const {
  std::vector<PressTrial> trials;
  for (const auto* result : results)
    if (holds_press(*result)) trials.push_back(press_from(*result));
  if (trials.empty()) return {};
  return tell_presses(fit_intrusions(trials), trials);
}

}  // namespace sandhopper
