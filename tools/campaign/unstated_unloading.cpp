#include "tools/campaign/unstated_unloading.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "terrain/accelerometer_fusion.hpp"
#include "tools/campaign/belief_sources.hpp"
#include "tools/campaign/force_at_depth.hpp"

namespace sandhopper {
namespace {

constexpr std::string_view kKey = "terrain.unloading_stiffness_ratio";
// A reading differs from the depth by at most this many standard deviations.
constexpr double kNoiseBand = 4.0;

// Depths with their rows.
struct Depths {
  explicit Depths(const TrialRecording& recording) {
    const auto z = recording.channel("foot_z_m");
    for (std::size_t row = 0; row < z.size(); ++row)
      if (!std::isnan(z[row])) rows.push_back(row), depth_m.push_back(-z[row]);
  }

  // Standard deviation of one depth; 0 for fewer than three.
  double noise_m() const { return depth_m.size() < 3 ? 0.0 : sample_noise(depth_m); }

  // Smallest difference of two depths that follow each other: the step of the digits, or less. 0: none
  // differ.
  double step_m() const {
    double step_m = 0.0;
    for (std::size_t i = 1; i < depth_m.size(); ++i) {
      const double change_m = std::abs(depth_m[i] - depth_m[i - 1]);
      if (change_m > 0.0 && (step_m == 0.0 || change_m < step_m)) step_m = change_m;
    }
    return step_m;
  }

  // Largest difference of two readings of a plate that stands still. In a hold, the deepest reading is too
  // deep by its noise and another one is too shallow: twice the band. Coarse digits hide the noise from
  // noise_m(), but still toggle by one step; 1.5 lies between one step and two, so rounding decides nothing.
  double at_rest_m() const { return std::max(2.0 * kNoiseBand * noise_m(), 1.5 * step_m()); }

  std::vector<std::size_t> rows;
  std::vector<double> depth_m;
};

bool is_unstated_in(const Campaign& campaign) {
  const auto used = used_numbers(campaign).numbers;
  const auto found = std::ranges::find(used, kKey, &UsedNumber::key);
  return found != used.end() && found->source == UsedNumber::Source::plant_default;
}

}  // namespace

UnstatedUnloading::UnstatedUnloading(const Campaign& campaign)
    : file_((campaign.model.empty() ? campaign.file : campaign.model).string()),
      is_unstated_(campaign.plant == CampaignPlant::intruder && is_unstated_in(campaign)) {}

void UnstatedUnloading::add(const CampaignTrial& trial, const TrialRecording& recording) {
  const bool pushes = trial.kind == TrialKind::intrusion || trial.kind == TrialKind::press;
  if (!is_unstated_ || !pushes || !recording.usable() || !recording.has_time || !recording.has("foot_z_m") ||
      !recording.has("force_N"))
    return;
  const Depths depths(recording);
  if (depths.rows.empty()) return;
  const auto deepest = std::ranges::max_element(depths.depth_m);
  const double moving_m = *deepest - depths.at_rest_m();
  const bool rises = std::any_of(deepest, depths.depth_m.end(), [&](double d) { return d < moving_m; });
  if (!(*deepest > 0.0) || !rises) return;
  auto last = deepest;
  while (last != depths.depth_m.begin() && *last >= moving_m) --last;
  const auto row_of = [&](auto place) {
    return depths.rows[static_cast<std::size_t>(place - depths.depth_m.begin())];
  };
  const ForceAtDepth pairs(recording);
  for (std::size_t i = 0; i < pairs.size(); ++i)
    rows_ += pairs.rows[i] > row_of(deepest) && pairs.z_m[i] < 0.0;
  ends_.push_back({trial.name, recording.t_s[row_of(last)]});
}

std::optional<Finding> UnstatedUnloading::finding() const {
  if (ends_.empty()) return std::nullopt;
  std::vector<std::string> ends;
  for (const auto& [trial, to_s] : ends_) ends.push_back(fmt::format("{:.6g} for {}", to_s, trial));
  return Finding{
      .kind = FindingKind::set_up,
      .severity = FindingSeverity::note,
      .file = file_,
      .line = 1,
      .column = 1,
      .channel = std::string(kKey),
      .what = fmt::format(
          "is stated nowhere, and {} rows after the deepest point of {} {} are compared with its default 1: "
          "the force falls as it rose, which no sand does",
          rows_, ends_.size(), ends_.size() == 1 ? "trial" : "trials"),
      .cure = fmt::format("state it in [terrain], or end each trial while its plate still goes down, with "
                          "select = {{ to_s = … }}: {}",
                          fmt::join(ends, ", "))};
}

}  // namespace sandhopper
