#include "tools/campaign/lost_channels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace sandhopper {
namespace {

bool has_samples(const TrialRecording& recording, std::string_view channel) {
  const auto* values = recording.find(channel);
  return values != nullptr && std::ranges::any_of(*values, [](double value) { return !std::isnan(value); });
}

}  // namespace

void LostChannels::add(const CampaignTrial& trial, const TrialRecording& recording) {
  if (!recording.usable()) return;
  std::set<std::string> wanted;
  for (const auto& mapping : trial.columns) wanted.insert(mapping.channel);
  for (const auto& companion : trial.companions)
    for (const auto& mapping : companion.columns) wanted.insert(mapping.channel);
  for (const auto& finding : recording.findings)
    if (finding.severity == FindingSeverity::channel_unusable) wanted.insert(finding.channel);
  for (const auto& channel : wanted)
    if (find_channel(plant_, channel) != nullptr && !has_samples(recording, channel)) ++trials_[channel];
}

std::string LostChannels::words() const {
  std::string words;
  for (const auto& [channel, count] : trials_)
    words += fmt::format(", without {} in {} {}", channel, count, count == 1 ? "trial" : "trials");
  return words;
}

}  // namespace sandhopper
