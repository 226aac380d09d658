#include "tools/campaign/force_unit_check.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "tools/campaign/deepest_push.hpp"
#include "tools/campaign/implausible.hpp"

namespace sandhopper {
namespace {

struct ForceDoubt {
  std::string why;
  double factor = 0.0;  // from the unit of the numbers to newtons, if they are in that one
};

// Between two units that differ by a factor of 1000 the limit is their geometric mean.
ForceDoubt doubt_of_newtons(const Campaign& campaign, const IntruderBelief& belief, const DeepestPush& most) {
  const double limit = std::sqrt(1000.0);
  if (const auto expected_N = believed_bearing_N(belief, most.depth_m)) {
    const double ratio = most.force_N / *expected_N;
    if ((ratio < 1.0 / limit || ratio > limit) && is_said(campaign, "terrain.stiffness_"))
      return {fmt::format("{:.3g} N at a depth of {:.3g} m, where the believed stiffness gives {:.3g} N",
                          most.force_N, most.depth_m, *expected_N),
              ratio < 1.0 ? 1000.0 : 0.001};
  }
  const double least_N = least_bearing_N(belief, most.depth_m);
  if (most.force_N >= least_N || !is_said(campaign, "foot.radius_m")) return {};
  return {
      fmt::format("{:.3g} N at a depth of {:.3g} m, where a foot of {:.3g} m bears {:.3g} N even in the "
                  "smoothest grains of {:.0f} kg/m3",
                  most.force_N, most.depth_m, 2.0 * belief.foot.radius_m, least_N, kLightestBed_kg_per_m3),
      1000.0};
}

}  // namespace

void check_force_unit(TrialRecording& recording, const Campaign& campaign, const CampaignTrial& trial,
                      const RecordingPlaces& places, bool depth_ends_early) {
  const bool pushes = trial.kind == TrialKind::intrusion || trial.kind == TrialKind::press;
  const auto* belief = std::get_if<IntruderBelief>(&trial.belief);
  if (belief == nullptr || !pushes || any_unusable(recording.findings)) return;
  const auto* column = places.column_of("force_N");
  if (column == nullptr || !recording.has("force_N") || !recording.has("foot_z_m")) return;
  auto most = deepest_push(recording);
  if (depth_ends_early)
    for (const double force_N : recording.channel("force_N")) most.force_N = std::fmax(most.force_N, force_N);
  if (!(most.force_N > 0.0) || !(most.depth_m > 0.0)) return;
  const auto doubt = doubt_of_newtons(campaign, *belief, most);
  // Without the depths of the largest forces only a force that is too small is in doubt.
  if (doubt.why.empty() || (depth_ends_early && doubt.factor < 1.0)) return;
  const auto what =
      fmt::format("reaches {}: the force, the depth or the belief is in another unit", doubt.why);
  auto cure = fmt::format(
      "if the numbers are in {}, write {} into [columns]; else correct the unit of "
      "foot_z_m, or the stiffness (N/mm? in N/m it is 1000 times as large) and the "
      "foot's size",
      doubt.factor > 1.0 ? "kN" : "mN", mapping_line(in_other_unit(*column, doubt.factor)));
  if (is_unit_assumed(trial, places, "force_N"))
    doubt_column(recording, places, false, "force_N",
                 what + ", and neither the file nor campaign.toml states the unit of the force",
                 cure + "; or, if all are right, " + confirming_line(*column));
  else
    add_implausible(recording, places, FindingSeverity::note, "force_N", what, std::move(cure));
}

}  // namespace sandhopper
