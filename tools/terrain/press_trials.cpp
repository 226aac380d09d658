#include "tools/terrain/press_trials.hpp"

#include <algorithm>
#include <cmath>

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

}  // namespace

bool PressTrials::takes(CampaignPlant plant, TrialKind kind) const {
  return plant == CampaignPlant::intruder &&
         (kind == TrialKind::intrusion || kind == TrialKind::press || kind == TrialKind::clamped);
}

void PressTrials::analyse(const CampaignTrial& trial, const TrialRecording& recording,
                          TrialResult& result) const {
  if (!slow(recording)) return;
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
