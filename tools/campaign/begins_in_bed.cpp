#include "tools/campaign/begins_in_bed.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "tools/campaign/force_at_depth.hpp"
#include "tools/campaign/implausible.hpp"
#include "tools/campaign/signal_noise.hpp"

namespace sandhopper {
namespace {

constexpr double kLeastExponent = 0.3;     // Bekker's n; see surface_onset.hpp
constexpr double kBeyondNoise = 5.0;       // in standard deviations
constexpr double kShareThatCounts = 0.01;  // of the peak, as in surface_check
constexpr std::size_t kFewestOfPart = 20;

// The offset of the depth by which its zero comes to the depth at which the line through the first fifth of
// the way down leads to no force.
std::string in_bed_cure(const ForceAtDepth& pairs, const RecordingPlaces& places) {
  constexpr double kFirst = 0.2;
  const double begin_m = -pairs.z_m.front(), way_m = kFirst * (-std::ranges::min(pairs.z_m) - begin_m);
  double n = 0, sz = 0, sf = 0, szz = 0, szf = 0;
  for (std::size_t i = 0; i < pairs.size() && -pairs.z_m[i] < begin_m + way_m; ++i) {
    const double depth_m = -pairs.z_m[i], force_N = pairs.force_N[i];
    n += 1, sz += depth_m, sf += force_N, szz += depth_m * depth_m, szf += depth_m * force_N;
  }
  const double slope_N_per_m = (szf - sz * sf / n) / (szz - sz * sz / n);
  const auto* column = places.column_of("foot_z_m");
  const std::string tare = "; if the force was not tared, subtract its reading in air instead";
  if (column == nullptr || !(slope_N_per_m > 0.0))
    return "count the depth from the undisturbed surface" + tare;
  auto moved = *column;
  moved.offset += sz / n - sf / n / slope_N_per_m;
  return fmt::format(
      "if the foot was in the bed, write {} into [columns], by a straight line back to no force{}",
      mapping_line(moved), tare);
}

}  // namespace

void check_begins_in_bed(TrialRecording& recording, const CampaignTrial& trial,
                         const RecordingPlaces& places) {
  if (any_unusable(recording.findings)) return;
  const ForceAtDepth pairs(recording);
  if (pairs.size() < kFewestOfPart) return;
  const double depth_m = -pairs.z_m.front(), deepest_m = -std::ranges::min(pairs.z_m);
  const double force_N = pairs.force_N.front(), most_N = std::ranges::max(pairs.force_N);
  const double unsure_m = kBeyondNoise * noise_of_bends(pairs.z_m);
  const double unsure_N = kBeyondNoise * noise_of_bends(pairs.force_N);
  if (depth_m < -unsure_m || !(deepest_m > depth_m + unsure_m)) return;
  const double part = std::min(1.0, std::max(0.0, depth_m + unsure_m) / deepest_m);
  if (force_N - unsure_N <= most_N * std::max(kShareThatCounts, std::pow(part, kLeastExponent))) return;
  const bool is_part = trial.rows.from_line != 0 || std::isfinite(trial.rows.from_s);
  if (!is_part)
    return add_implausible(
        recording, places, FindingSeverity::note, "foot_z_m",
        fmt::format(
            "is {:.3g} mm in the first row, with {:.3g} N, more than any foot meets so near to the surface: "
            "the zero of the depth was set in the bed, or the force was not tared",
            1e3 * std::abs(depth_m), force_N),
        in_bed_cure(pairs, places));
  doubt_column(
      recording, places, places.is_stated("foot_z_m"), "foot_z_m",
      fmt::format("begins at a depth of {:.3g} mm with {:.3g} N, more than any foot meets so near to the "
                  "surface: its zero was set in the bed, or the force was not tared",
                  1e3 * std::abs(depth_m), force_N),
      "write foot_z_m into `columns` of this [[trial]] with the offset by which it goes on from the rows "
      "before these");
}

}  // namespace sandhopper
