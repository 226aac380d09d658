#include <algorithm>
#include <cmath>
#include <limits>

#include "tools/diagnose/data_fault_parts.hpp"

namespace sandhopper::diagnose {
namespace {

constexpr double kPileUp = 0.01;    // of all samples, exactly on the end value
constexpr std::size_t kLeast = 6;   // samples there
constexpr std::size_t kInARow = 4;  // of them whose forerunner is there, too: a blow is short
constexpr double kGridSteps = 3.0;  // noise must move the sensor by this many
constexpr double kLifted = 3.0;     // standard deviations that noise may take a sample off the limit

// An accelerometer clips; the other sensors saturate.
std::string range_fault(const std::string& channel) {
  return channel.starts_with("imu_") ? "imu.clipping" : "sensor.saturation";
}

}  // namespace

void find_clipping(std::vector<Trial>& trials, const std::string& channel, std::vector<DataFault>& faults) {
  const auto samples = sampled(trials, channel);
  double low = 1e300, high = -1e300, total = 0.0;
  for (const auto& s : samples)
    for (const double v : s.value) {
      low = std::min(low, v);
      high = std::max(high, v);
      ++total;
    }
  const double noise = own_noise(samples), grid = value_grid(samples);
  if (total >= 50.0 && high == low && high != 0.0 && samples.size() > 1) {
    // The same value in all trials is no sensor that fell asleep: it rests at its end all the time.
    DataFault always{.channel = channel,
                     .id = range_fault(channel),
                     .stretches = samples.size(),
                     .limit = high,
                     .borderline = true,
                     .trials = {}};
    for (const auto& s : samples) always.trials.push_back(s.trial->name);
    faults.push_back(std::move(always));
    return;
  }
  if (total < 50.0 || !(high > low) || noise < kGridSteps * grid) return;
  DataFault fault;
  fault.channel = channel;
  fault.id = range_fault(channel);
  fault.limit_resolution = 0.5 * grid;
  for (const double end : {high, low}) {
    double at_end = 0.0, next = 0.0;
    std::size_t in_a_row = 0;
    for (const auto& s : samples)
      for (std::size_t i = 0; i < s.value.size(); ++i) {
        const double v = s.value[i];
        at_end += v == end ? 1.0 : 0.0;
        in_a_row += i > 0 && v == end && s.value[i - 1] == end;
        next += v != end && std::abs(v - end) < 4.5 * grid ? 1.0 : 0.0;
      }
    // Without a limit the end value is met about as often as the four steps below it.
    if (at_end < static_cast<double>(kLeast) || at_end < 3.0 * (next + 1.0)) continue;
    if (at_end < kPileUp * total && in_a_row < kInARow) continue;
    if (fault.limit != 0.0 && std::abs(end) < std::abs(fault.limit)) continue;
    fault.limit = end;
  }
  if (fault.limit == 0.0) return;
  const bool both = high == -low;
  for (const auto& s : samples) {
    auto& values = s.trial->channels[channel];
    bool hit = false;
    for (std::size_t i = 0; i < s.value.size(); ++i) {
      const double v = s.value[i];
      const double beyond = both ? std::abs(v) - high : fault.limit == high ? v - high : low - v;
      hit = hit || beyond == 0.0;
      if (beyond > -kLifted * noise) values[s.rows[i]] = std::numeric_limits<double>::quiet_NaN();
    }
    if (hit) {
      fault.trials.push_back(s.trial->name);
      ++fault.stretches;
    }
  }
  faults.push_back(std::move(fault));
}

}  // namespace sandhopper::diagnose
