#include "tools/diagnose/recordings/contradicted_ranges.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "tools/diagnose/fit/levels.hpp"
#include "tools/diagnose/fit/statistics.hpp"
#include "tools/diagnose/recordings/data_fault_parts.hpp"

namespace sandhopper::diagnose {
namespace {

struct RangeKey {
  std::string key, sensor, unit;
};

// The keys "sensors.SENSOR_range_UNIT" of a belief.
std::vector<RangeKey> range_keys(const Belief& belief) {
  static const std::string kHead = "sensors.", kMiddle = "_range_";
  std::vector<RangeKey> keys;
  for (const auto& [key, value] : belief.numbers) {
    const auto at = key.find(kMiddle);
    if (value > 0.0 && key.starts_with(kHead) && at != std::string::npos)
      keys.push_back({key, key.substr(kHead.size(), at - kHead.size()), key.substr(at + kMiddle.size())});
  }
  return keys;
}

bool is_of(const RangeKey& range, const std::string& channel) {
  if (!channel.ends_with("_" + range.unit) || channel.starts_with("command_")) return false;
  return range.sensor == "load_cell" ? channel.ends_with("force_N")
                                     : channel.find(range.sensor) != std::string::npos;
}

}  // namespace

std::vector<std::string> drop_contradicted_ranges(Recordings& recordings) {
  constexpr double kRounding = 1e-3;  // of the range: it is stated to three digits
  std::set<std::string> channels;
  for (const auto& trial : recordings.trials)
    for (const auto& [name, values] : trial.channels) channels.insert(name);
  std::vector<std::string> notes;
  for (const auto& range : range_keys(recordings.belief))
    for (const auto& channel : channels) {
      if (!is_of(range, channel)) continue;
      const auto samples = sampled(recordings.trials, channel);
      double farthest = 0.0;
      for (const auto& s : samples)
        for (const double v : s.value)
          if (std::abs(v) > std::abs(farthest)) farthest = v;
      const double limit = recordings.belief.value(range.key);
      const double noise = own_noise(samples) * normal_quantile(kBeyondDoubt);
      if (std::abs(farthest) <= (1.0 + kRounding) * limit + noise) continue;
      notes.push_back(fmt::format("{} reads {:.4g}, beyond {} = {:.4g} of the belief: that range is not used",
                                  channel, farthest, range.key, limit));
      recordings.belief.numbers.erase(range.key);
      for (auto& belief : recordings.beliefs) belief.numbers.erase(range.key);
      break;
    }
  return notes;
}

}  // namespace sandhopper::diagnose
