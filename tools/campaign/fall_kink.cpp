#include "tools/campaign/fall_kink.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "estimation/leg.hpp"
#include "tools/campaign/implausible.hpp"
#include "tools/campaign/signal_noise.hpp"

namespace sandhopper {
namespace {

constexpr std::size_t kSpeedRows = 4;  // on each side of a row, as in clock_checks
constexpr double kKinkClear = 5.0;     // in standard deviations
constexpr double kMostFall = 1.5;      // in g, as in fall_check

struct FallHeights {
  explicit FallHeights(const TrialRecording& recording) {
    const auto heights = recording.channel("height_m");
    std::vector<double> without_fall;  // The curvature of a fall is no noise.
    for (std::size_t row = 0; row < heights.size(); ++row) {
      if (std::isnan(heights[row])) continue;
      rows.push_back(row), t_s.push_back(recording.t_s[row]), z_m.push_back(heights[row]);
      without_fall.push_back(z_m.back() + 0.5 * kGravity_mps2 * t_s.back() * t_s.back());
    }
    noise_m = std::max(noise_of_bends(without_fall), digit_of(without_fall));
  }

  double speed(std::size_t first) const {
    return (z_m[first + kSpeedRows] - z_m[first]) / (t_s[first + kSpeedRows] - t_s[first]);
  }
  double middle_s(std::size_t first) const { return 0.5 * (t_s[first + kSpeedRows] + t_s[first]); }

  // Change of the speed from the rows up to `at` to those from at + 1 on, beyond what a fall at 1.5 g and the
  // noise explain; negative downward.
  double beyond_mps(std::size_t at) const {
    const std::size_t before = at - kSpeedRows, after = at + 1;
    const double change = speed(after) - speed(before), apart_s = middle_s(after) - middle_s(before);
    const double span_s = std::min(t_s[at] - t_s[before], t_s[after + kSpeedRows] - t_s[after]);
    return change + kMostFall * kGravity_mps2 * apart_s + kKinkClear * 2.0 * noise_m / span_s;
  }

  std::vector<std::size_t> rows;
  std::vector<double> t_s, z_m;
  double noise_m = 0.0;
};

// True if the body goes on as fast as after the kink, and did not only make one step there.
bool goes_on_faster(const FallHeights& fall, std::size_t at) {
  const std::size_t after = at + 1, later = after + kSpeedRows;
  if (later + kSpeedRows >= fall.z_m.size()) return false;
  return fall.speed(later) < 0.5 * (fall.speed(at - kSpeedRows) + fall.speed(after));
}

// The row of the only kink: beside it, farther than its own windows reach, the fall is even.
std::optional<std::size_t> only_kink(const FallHeights& fall) {
  constexpr std::size_t kReach = kSpeedRows + 1;
  std::optional<std::size_t> at;
  double most = 0.0;
  for (std::size_t i = kSpeedRows; i + kReach < fall.z_m.size(); ++i)
    if (const double beyond = fall.beyond_mps(i); beyond < most) most = beyond, at = i;
  if (!at || !goes_on_faster(fall, *at)) return std::nullopt;
  for (std::size_t i = kSpeedRows; i + kReach < fall.z_m.size(); ++i)
    if ((i + kReach <= *at || *at + kReach <= i) && fall.beyond_mps(i) < 0.0) return std::nullopt;
  return at;
}

}  // namespace

void check_fall_kink(TrialRecording& recording, const Campaign& campaign, const RecordingPlaces& places) {
  constexpr std::size_t kFewestHeights = 20;
  if (campaign.plant != CampaignPlant::falling_body || !recording.has_time || !recording.has("height_m"))
    return;
  if (any_unusable(recording.findings)) return;
  const FallHeights fall(recording);
  if (fall.z_m.size() < kFewestHeights) return;
  const auto at = only_kink(fall);
  if (!at) return;
  const double before = fall.speed(*at - kSpeedRows), after = fall.speed(*at + 1);
  doubt_column(
      recording, places, places.is_stated("t_s"), "t_s",
      fmt::format(
          "height_m falls with {:.3g} m/s up to line {} and with {:.3g} m/s from the next row on: nothing "
          "pulls a falling body, so the rows there are farther apart than their times, as frames of a "
          "camera whose rate changed",
          -before, places.line_of(fall.rows[*at]), -after),
      "write the time of each frame from the video file (ffprobe -select_streams v -show_entries "
      "frame=best_effort_timestamp_time -of csv=p=0 FILM), not the row number divided by a mean rate");
}

}  // namespace sandhopper
