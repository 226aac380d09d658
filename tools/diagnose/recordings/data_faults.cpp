#include "tools/diagnose/recordings/data_faults.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "tools/diagnose/plants/inputs.hpp"
#include "tools/diagnose/recordings/data_fault_parts.hpp"

namespace sandhopper::diagnose {

std::vector<SampledChannel> sampled(std::vector<Trial>& trials, const std::string& channel) {
  std::vector<SampledChannel> all;
  for (auto& trial : trials) {
    const auto* values = trial.find(channel);
    if (values == nullptr) continue;
    SampledChannel s{&trial, {}, {}, {}};
    for (std::size_t i = 0; i < values->size(); ++i)
      if (std::isfinite((*values)[i])) {
        s.rows.push_back(i);
        s.value.push_back((*values)[i]);
        s.time_s.push_back(trial.time_s[i]);
      }
    if (!s.value.empty()) all.push_back(std::move(s));
  }
  return all;
}

double value_grid(const std::vector<SampledChannel>& channel) {
  double grid = std::numeric_limits<double>::infinity();
  for (const auto& s : channel)
    for (std::size_t i = 1; i < s.value.size(); ++i) {
      const double step = std::abs(s.value[i] - s.value[i - 1]);
      if (step > 1e-9 * std::abs(s.value[i])) grid = std::min(grid, step);
    }
  return std::isfinite(grid) ? grid : 0.0;
}

double own_noise(const std::vector<SampledChannel>& channel) {
  std::vector<double> of_trial;
  of_trial.reserve(channel.size());
  for (const auto& s : channel) of_trial.push_back(fluctuation_rms({s.time_s, s.value}));
  if (of_trial.empty()) return 0.0;
  const auto middle = of_trial.begin() + static_cast<std::ptrdiff_t>(of_trial.size() / 2);
  std::nth_element(of_trial.begin(), middle, of_trial.end());
  return *middle;
}

std::vector<DataFault> remove_data_faults(std::vector<Trial>& trials) {
  std::set<std::string> channels;
  for (const auto& trial : trials)
    for (const auto& [name, values] : trial.channels)
      if (name != "phase" && !name.starts_with("command_") && !name.starts_with("estimate_") &&
          !name.ends_with("temperature_C") && name != "bus_voltage_V")
        channels.insert(name);
  std::vector<DataFault> faults;
  find_lost_rows(trials, faults);
  for (const auto& channel : channels) {
    find_dropouts(trials, channel, faults);
    find_stuck(trials, channel, faults);
    find_clipping(trials, channel, faults);
    find_spikes(trials, channel, faults);  // last: samples at a code are dropouts
  }
  return faults;
}

}  // namespace sandhopper::diagnose
