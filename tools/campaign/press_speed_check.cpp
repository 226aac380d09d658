#include "tools/campaign/press_speed_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "tools/campaign/implausible.hpp"
#include "tools/campaign/unit_ratios.hpp"

namespace sandhopper {
namespace {

using enum FindingSeverity;

constexpr std::size_t kFewestOfStroke = 10;

// Speed downward of the first even stroke, m/s.
std::optional<double> even_speed(const TrialRecording& recording) {
  const auto z = recording.channel("foot_z_m");
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < z.size(); ++i)
    if (!std::isnan(z[i])) rows.push_back(i);
  if (rows.size() < kFewestOfStroke) return std::nullopt;
  const auto deepest = std::ranges::min_element(rows, {}, [&](std::size_t i) { return z[i]; });
  const double top = z[rows.front()], width = top - z[*deepest];
  if (!(width > 0.0)) return std::nullopt;
  double n = 0, st = 0, sz = 0, stt = 0, stz = 0, szz = 0;
  std::size_t begin = 0;
  const auto end = static_cast<std::size_t>(deepest - rows.begin());
  for (std::size_t k = 0; k < end; ++k)
    if (top - z[rows[k]] < 0.1 * width) begin = k;
  for (std::size_t k = begin; k < end && top - z[rows[k]] < 0.9 * width; ++k) {
    const double t = recording.t_s[rows[k]] - recording.t_s[rows[begin]], depth = top - z[rows[k]];
    n += 1, st += t, sz += depth, stt += t * t, stz += t * depth, szz += depth * depth;
  }
  const double tt = n * stt - st * st, zz = n * szz - sz * sz, tz = n * stz - st * sz;
  if (n < static_cast<double>(kFewestOfStroke) || !(tt > 0.0) || !(zz > 0.0)) return std::nullopt;
  if (tz * tz < 0.99 * tt * zz) return std::nullopt;
  return tz / tt;
}

}  // namespace

void check_press_speed(TrialRecording& recording, const Campaign& campaign, const CampaignTrial& trial,
                       const RecordingPlaces& places) {
  const auto stated = trial.number("impact_speed_mps");
  if (campaign.plant != CampaignPlant::intruder || !recording.has_time || !recording.has("foot_z_m")) return;
  if (!stated || !(*stated > 0.0)) return;
  const auto seen = even_speed(recording);
  if (!seen || !(*seen > 0.0)) return;
  const double ratio = *seen / *stated;
  std::optional<double> unit;
  for (const std::span<const double> ratios : {std::span<const double>(kLengthRatios), {kRateRatios}})
    for (const double known : ratios)
      if (!unit && std::abs(ratio / known - 1.0) < 0.03) unit = known;
  if (ratio > 0.2 && ratio < 5.0 && !unit) return;
  const auto* z = places.column_of("foot_z_m");
  const bool is_own = places.is_stated("foot_z_m");
  std::string cure = "correct the unit of foot_z_m or of t_s, or impact_speed_mps";
  if (z != nullptr && unit)
    cure = fmt::format(
        "write {} into [columns], or impact_speed_mps = {:.4g} into the [[trial]], whichever is true",
        mapping_line(in_other_unit(*z, 1.0 / *unit)), *seen);
  else if (recording.has("force_N"))
    cure += "; or the columns of foot_z_m and force_N are exchanged";
  add_implausible(recording, places, is_own ? note : trial_unusable, "foot_z_m",
                  fmt::format("goes down at {:.4g} m/s, and impact_speed_mps is {:.4g}: {:.3g} times that",
                              *seen, *stated, ratio),
                  is_own ? "taken as stated in [columns]; then correct impact_speed_mps" : std::move(cure));
}

}  // namespace sandhopper
