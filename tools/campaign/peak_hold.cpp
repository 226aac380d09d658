#include "tools/campaign/peak_hold.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "tools/campaign/force_at_depth.hpp"
#include "tools/campaign/implausible.hpp"

namespace sandhopper {

bool check_peak_hold(TrialRecording& recording, const CampaignTrial& trial, const RecordingPlaces& places) {
  constexpr std::size_t kFewestRisen = 20;  // rows that go up, as in lost_forces
  constexpr double kHalf = 0.5;             // of the deepest depth
  const bool pushes = trial.kind == TrialKind::intrusion || trial.kind == TrialKind::press;
  const ForceAtDepth pairs(recording);
  if (!pushes || pairs.size() < 2 * kFewestRisen) return false;
  const auto& force = pairs.force_N;
  std::size_t risen = 0;
  for (std::size_t i = 1; i < force.size(); ++i) {
    if (force[i] < force[i - 1]) return false;
    risen += force[i] > force[i - 1];
  }
  const auto deepest = static_cast<std::size_t>(std::ranges::min_element(pairs.z_m) - pairs.z_m.begin());
  const double depth_m = -pairs.z_m[deepest], up_m = pairs.z_m.back() - pairs.z_m[deepest];
  const auto peak = static_cast<std::size_t>(std::ranges::find(force, force.back()) - force.begin());
  const double at_peak_m = pairs.z_m.back() - pairs.z_m[std::max(peak, deepest)];
  if (risen < kFewestRisen || !(depth_m > 0.0) || at_peak_m < kHalf * depth_m) return false;
  doubt_column(
      recording, places, places.is_stated("force_N"), "force_N",
      fmt::format(
          "never falls from row to row, and stays at its largest value, {:.3g} N, while the foot comes up by "
          "{:.3g} mm: the gauge holds its peak",
          force.back(), 1e3 * up_m),
      fmt::format(
          "use the rows down to the deepest one, select = {{ to_line = {} }} in this [[trial]], or switch "
          "the peak hold off and record again",
          places.line_of(pairs.rows[deepest])));
  return true;
}

}  // namespace sandhopper
