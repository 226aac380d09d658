#include "tools/campaign/trial_recording.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace sandhopper {

const std::vector<double>* TrialRecording::find(std::string_view name) const {
  const auto found = std::find_if(channels.begin(), channels.end(),
                                  [&](const Channel& channel) { return channel.name == name; });
  return found == channels.end() ? nullptr : &found->values;
}

std::span<const double> TrialRecording::channel(std::string_view name) const {
  const auto* values = find(name);
  if (values == nullptr) throw std::out_of_range("no channel " + std::string(name));
  return *values;
}

const SaturatedRows* TrialRecording::saturation(std::string_view name) const {
  const auto found = std::find_if(saturated.begin(), saturated.end(),
                                  [&](const SaturatedRows& rows) { return rows.channel == name; });
  return found == saturated.end() ? nullptr : &*found;
}

bool TrialRecording::is_saturated(std::string_view name, std::size_t row) const {
  const auto* values = find(name);
  if (values == nullptr) return false;
  return std::any_of(saturated.begin(), saturated.end(), [&](const SaturatedRows& rows) {
    return rows.channel == name && (*values)[row] == rows.limit;
  });
}

}  // namespace sandhopper
