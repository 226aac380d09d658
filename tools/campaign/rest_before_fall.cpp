#include "tools/campaign/rest_before_fall.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace sandhopper {
namespace {

constexpr std::size_t kFewest = 10;   // rows of the first half of the way
constexpr double kCertain = 4.0;      // in standard errors
constexpr double kPartsOfARow = 4.0;  // steps in which the instant is looked for

struct Height {
  double t_s, height_m;
};

// From the first row to where the body has fallen by half of its way; air brakes it little until then.
std::vector<Height> first_half(std::span<const double> time_s, std::span<const double> height_m) {
  std::vector<Height> rows;
  for (std::size_t i = 0; i < time_s.size(); ++i)
    if (!std::isnan(height_m[i])) rows.push_back({time_s[i], height_m[i]});
  if (rows.empty()) return rows;
  const auto lowest = std::ranges::min_element(rows, {}, &Height::height_m)->height_m;
  const double half_m = 0.5 * (rows.front().height_m + lowest);
  rows.erase(std::ranges::find_if(rows, [&](const Height& row) { return row.height_m < half_m; }),
             rows.end());
  return rows;
}

// Sum of squared residuals of h = h0 - b max(0, t - rest)^2; that of a constant if the best b is negative.
double misfit(const std::vector<Height>& rows, double rest_s) {
  const auto n = static_cast<double>(rows.size());
  const auto way = [&](const Height& row) {
    return std::pow(std::max(0.0, row.t_s - rows.front().t_s - rest_s), 2);
  };
  double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;
  for (const auto& row : rows) x += way(row) / n, y += row.height_m / n;
  for (const auto& row : rows) {
    xx += std::pow(way(row) - x, 2), yy += std::pow(row.height_m - y, 2);
    xy += (way(row) - x) * (row.height_m - y);
  }
  return yy - (xx > 0.0 && xy < 0.0 ? xy * xy / xx : 0.0);
}

}  // namespace

std::optional<double> rest_before_fall_s(std::span<const double> time_s, std::span<const double> height_m) {
  const auto rows = first_half(time_s, height_m);
  if (rows.size() < kFewest) return std::nullopt;
  const double step_s = (rows.back().t_s - rows.front().t_s) / static_cast<double>(rows.size() - 1);
  const double last_s = rows[rows.size() - kFewest / 2].t_s - rows.front().t_s;
  double best = misfit(rows, 0.0), best_s = 0.0;
  const double at_once = best;
  for (double rest_s = 0.0; rest_s < last_s; rest_s += step_s / kPartsOfARow)
    if (const double found = misfit(rows, rest_s); found < best) best = found, best_s = rest_s;
  const double variance = best / static_cast<double>(rows.size() - 3);
  if (best_s <= step_s || at_once - best < kCertain * kCertain * variance) return std::nullopt;
  return best_s;
}

void check_rest_before_fall(TrialRecording& recording, const Campaign& campaign, const CampaignTrial& trial,
                            const RecordingPlaces& places) {
  const auto speed = [&](std::string_view key) { return trial.number(key).value_or(0.0); };
  if (campaign.plant != CampaignPlant::falling_body || trial.kind != TrialKind::drop) return;
  if (!recording.has_time || !recording.has("height_m") || any_unusable(recording.findings)) return;
  if (!trial.number("release_height_m") || recording.has("accel_mps2")) return;
  if (speed("release_speed_mps") != 0.0 || speed("impact_speed_mps") != 0.0) return;
  const auto rest_s = rest_before_fall_s(recording.t_s, recording.channel("height_m"));
  if (!rest_s) return;
  const double from_s = recording.t_s.front() + *rest_s;
  const auto row =
      static_cast<std::size_t>(std::ranges::lower_bound(recording.t_s, from_s) - recording.t_s.begin());
  recording.findings.push_back(
      {FindingKind::set_up, FindingSeverity::note, places.file, places.line_of(0), 1, "height_m",
       fmt::format("the body rests for {:.3g} s before it falls (until line {}): taken as held until then, "
                   "unless the height comes late by that time",
                   *rest_s, places.line_of(row)),
       fmt::format("write select = {{ from_s = {:.4f} }} into the [[trial]], or the instant that you know",
                   from_s)});
}

}  // namespace sandhopper
