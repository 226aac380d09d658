#include "tools/campaign/joined_press.hpp"

#include <algorithm>
#include <span>
#include <string_view>
#include <utility>

#include "tools/campaign/sample_checks.hpp"

namespace sandhopper {
namespace {

// A mapping of the second file stands in `also`.
std::string in_also(std::string cure) {
  constexpr std::string_view kColumns = "[columns]", kAlso = "the columns of its also = { … }";
  for (auto at = cure.find(kColumns); at != std::string::npos; at = cure.find(kColumns, at + kAlso.size()))
    cure.replace(at, kColumns.size(), kAlso);
  return cure;
}

}  // namespace

JoinedPress::JoinedPress(const TrialRecording& first, const RecordingPlaces& places,
                         const TrialRecording& second, const RecordingPlaces& other_places) {
  const auto has_both = [](const TrialRecording& a, const TrialRecording& b) {
    return a.has("force_N") && b.has("foot_z_m");
  };
  force_is_second_ = has_both(second, first);
  is_new_ = !has_both(first, first) && (force_is_second_ || has_both(first, second));
  if (!is_new_) return;
  first_ = places, second_ = other_places;
  force_t_s_ = force_is_second_ ? second.t_s : first.t_s;
}

RecordingPlaces JoinedPress::places_at(const std::vector<double>& t_s) const {
  RecordingPlaces joined = first_;
  joined.columns.insert(joined.columns.end(), second_.columns.begin(), second_.columns.end());
  const auto& force = force_is_second_ ? second_ : first_;
  joined.file = force.file;
  joined.lines.clear();
  for (const double time_s : t_s) {
    const auto row = std::ranges::lower_bound(force_t_s_, time_s) - force_t_s_.begin();
    joined.lines.push_back(force.line_of(static_cast<std::size_t>(row)));
  }
  return joined;
}

void JoinedPress::check(TrialRecording& joined, const Campaign& campaign, const CampaignTrial& trial) const {
  if (!is_new_ || !joined.usable() || !joined.has("force_N") || !joined.has("foot_z_m")) return;
  const std::size_t before = joined.findings.size();
  check_press(joined, campaign, trial, places_at(joined.t_s));
  const std::string_view in_second = force_is_second_ ? "force_N" : "foot_z_m";
  for (auto& finding : std::span(joined.findings).subspan(before)) {
    if (finding.channel != "force_N" && finding.channel != "foot_z_m") continue;
    const bool is_second = finding.channel == in_second;
    finding.file = is_second ? second_.file : first_.file;
    if (is_second) finding.cure = in_also(std::move(finding.cure));
  }
}

}  // namespace sandhopper
