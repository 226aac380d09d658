#include "tools/diagnose/plants/doable.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tools/diagnose/plants/inputs.hpp"

namespace sandhopper::diagnose {

Trial recorded_like(const Trial& sample, double duration_s,
                    const std::function<double(const std::string&, double)>& value) {
  Trial trial;
  trial.name = "next";
  trial.kind = sample.kind;
  const double step_s = median_step_s(sample.time_s);
  const auto rows = static_cast<std::size_t>(std::max(0.0, duration_s / step_s)) + 1;
  for (std::size_t i = 0; i < rows; ++i) trial.time_s.push_back(step_s * static_cast<double>(i));
  for (const auto& [channel, unused] : sample.channels) {
    const auto samples = samples_of(sample, channel);
    if (samples.value.size() < 2) continue;
    const auto every =
        static_cast<std::size_t>(std::max(1.0, std::round(median_step_s(samples.time_s) / step_s)));
    auto& values = trial.channels[channel];
    values.assign(rows, std::numeric_limits<double>::quiet_NaN());
    for (std::size_t i = 0; i < rows; i += every) values[i] = value(channel, trial.time_s[i]);
  }
  return trial;
}

Extent extent_of(const std::vector<Trial>& recorded, const std::string& key, double otherwise) {
  Extent extent{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const auto& trial : recorded)
    if (const auto it = trial.setup.find(key); it != trial.setup.end()) {
      extent.low = std::min(extent.low, it->second);
      extent.high = std::max(extent.high, it->second);
    }
  return extent.low <= extent.high ? extent : Extent{otherwise, otherwise};
}

}  // namespace sandhopper::diagnose
