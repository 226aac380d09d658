#include "tools/campaign/begins_in_bed.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/campaign/force_at_depth.hpp"
#include "tools/campaign/implausible.hpp"
#include "tools/campaign/signal_noise.hpp"

namespace sandhopper {
namespace {

constexpr double kLeastExponent = 0.3;  // Bekker's n; see surface_onset.hpp
constexpr double kBeyondNoise = 5.0;    // in standard deviations
constexpr std::size_t kFewestOfPart = 20;

}  // namespace

void check_begins_in_bed(TrialRecording& recording, const CampaignTrial& trial,
                         const RecordingPlaces& places) {
  if (trial.rows.from_line == 0 && !std::isfinite(trial.rows.from_s)) return;
  if (any_unusable(recording.findings)) return;
  const ForceAtDepth pairs(recording);
  if (pairs.size() < kFewestOfPart) return;
  const double depth_m = -pairs.z_m.front(), deepest_m = -std::ranges::min(pairs.z_m);
  const double force_N = pairs.force_N.front(), most_N = std::ranges::max(pairs.force_N);
  const double unsure_m = kBeyondNoise * noise_of_bends(pairs.z_m);
  const double unsure_N = kBeyondNoise * noise_of_bends(pairs.force_N);
  if (depth_m < -unsure_m || !(deepest_m > depth_m + unsure_m)) return;
  const double part = std::min(1.0, std::max(0.0, depth_m + unsure_m) / deepest_m);
  if (force_N - unsure_N <= most_N * std::pow(part, kLeastExponent)) return;
  doubt_column(
      recording, places, places.is_stated("foot_z_m"), "foot_z_m",
      fmt::format("begins at a depth of {:.3g} mm with {:.3g} N, more than any foot meets so near to the "
                  "surface: its zero was set in the bed, or the force was not tared",
                  1e3 * std::abs(depth_m), force_N),
      "write foot_z_m into `columns` of this [[trial]] with the offset by which it goes on from the rows "
      "before these");
}

}  // namespace sandhopper
