#include "tools/campaign/early_end.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/campaign/implausible.hpp"

namespace sandhopper {

bool forces_outlast_depths(const TrialRecording& recording) {
  const auto depth = recording.channel("foot_z_m"), force = recording.channel("force_N");
  double before_s = NAN, longest_s = 0.0, after_s = 0.0;
  for (std::size_t row = 0; row < depth.size(); ++row) {
    const double since_s = recording.t_s[row] - before_s;
    if (!std::isnan(depth[row])) {
      longest_s = std::fmax(longest_s, since_s);
      before_s = recording.t_s[row];
      after_s = 0.0;
    } else if (!std::isnan(force[row])) {
      after_s = since_s;
    }
  }
  return after_s > longest_s;
}

bool note_early_end(TrialRecording& recording, const RecordingPlaces& places) {
  if (!recording.has("foot_z_m") || !recording.has("force_N") || !recording.has_time) return false;
  const auto is_missing = [](double value) { return std::isnan(value); };
  const auto depth = recording.channel("foot_z_m"), force = recording.channel("force_N");
  const auto first_missing = std::ranges::find_if(depth, is_missing);
  const auto end = static_cast<std::size_t>(first_missing - depth.begin());
  if (end < 2 || !std::all_of(first_missing, depth.end(), is_missing) || !forces_outlast_depths(recording))
    return false;
  const auto last_force =
      std::find_if_not(force.rbegin(), force.rend(), is_missing).base() - force.begin() - 1;
  const double step_s = (recording.t_s[static_cast<std::size_t>(last_force)] - recording.t_s.front()) /
                        static_cast<double>(end - 1);
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
