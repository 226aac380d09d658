#include "tools/campaign/early_end.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/campaign/implausible.hpp"

namespace sandhopper {

bool note_early_end(TrialRecording& recording, const RecordingPlaces& places) {
  if (!recording.has("foot_z_m") || !recording.has("force_N") || !recording.has_time) return false;
  const auto depth = recording.channel("foot_z_m"), force = recording.channel("force_N");
  std::size_t end = 0, last_force = 0;
  double longest_s = 0.0;
  for (; end < depth.size() && !std::isnan(depth[end]); ++end)
    if (end > 0) longest_s = std::max(longest_s, recording.t_s[end] - recording.t_s[end - 1]);
  for (std::size_t row = end; row < depth.size(); ++row) {
    if (!std::isnan(depth[row])) return false;
    if (!std::isnan(force[row])) last_force = row;
  }
  if (end < 2 || last_force < end || recording.t_s[last_force] - recording.t_s[end - 1] <= longest_s)
    return false;
  const double step_s = (recording.t_s[last_force] - recording.t_s.front()) / static_cast<double>(end - 1);
  add_implausible(
      recording, places, FindingSeverity::note, "foot_z_m",
      fmt::format(
          "stands in each of the first {} rows and in none of the {} below, where force_N goes on: it "
          "ended there, or a slower sensor's samples stand below each other from the top, and not in "
          "the rows of their times",
          end, depth.size() - end),
      fmt::format("in the second case take foot_z_m out of [columns] and write also = {{ file = the same, "
                  "columns = {{ foot_z_m = … }}, format = {{ row_every_s = {:.4g} }} }} with the time from "
                  "sample to sample",
                  step_s));
  return true;
}

}  // namespace sandhopper
