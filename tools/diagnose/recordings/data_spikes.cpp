#include <algorithm>
#include <cmath>
#include <limits>

#include "tools/diagnose/fit/statistics.hpp"
#include "tools/diagnose/recordings/data_fault_parts.hpp"

namespace sandhopper::diagnose {
namespace {

constexpr std::size_t kLongest = 2;  // samples of one spike

// Readings of a position. It cannot jump away and come back within a row; a force or an acceleration can.
bool is_position(const std::string& channel) {
  return channel.ends_with("_z_m") || channel.ends_with("height_m") || channel.ends_with("position_rad");
}

double median_change_beside(const std::vector<double>& v, std::size_t first, std::size_t last) {
  std::vector<double> changes;
  for (std::size_t i = first > kJumpNeighbours ? first - kJumpNeighbours : 1; i < first; ++i)
    changes.push_back(std::abs(v[i] - v[i - 1]));
  for (std::size_t i = last + 2; i < std::min(v.size(), last + 2 + kJumpNeighbours); ++i)
    changes.push_back(std::abs(v[i] - v[i - 1]));
  return changes.empty() ? std::numeric_limits<double>::infinity() : median(std::move(changes));
}

// Jump of the samples from first to last off the line between the samples before and after; 0: no spike.
double spike(const std::vector<double>& v, std::size_t first, std::size_t last, double noise) {
  const double before = v[first - 1], after = v[last + 1];
  double least = std::numeric_limits<double>::infinity(), most = 0.0, side = 0.0;
  for (std::size_t i = first; i <= last; ++i) {
    for (const double off : {v[i] - before, v[i] - after}) {
      if (side == 0.0) side = std::copysign(1.0, off);
      least = std::min(least, side * off);
      most = std::max(most, side * off);
    }
  }
  const bool jumps = least > kOutlying * std::max(noise, median_change_beside(v, first, last));
  return jumps && std::abs(before - after) < kAlike * least ? most : 0.0;
}

}  // namespace

void find_spikes(std::vector<Trial>& trials, const std::string& channel, std::vector<DataFault>& faults) {
  if (!is_position(channel)) return;
  const auto samples = sampled(trials, channel);
  const double noise = own_noise(samples), grid = value_grid(samples);
  DataFault fault;
  fault.channel = channel;
  fault.id = "data.spike";
  for (const auto& s : samples) {
    auto& values = s.trial->channels[channel];
    const auto stretches = fault.stretches;
    for (std::size_t first = 1; first + 1 < s.value.size(); ++first)
      for (std::size_t last = first; last < first + kLongest && last + 1 < s.value.size(); ++last) {
        const double jump = spike(s.value, first, last, std::max(noise, grid));
        if (jump == 0.0) continue;
        for (std::size_t i = first; i <= last; ++i)
          values[s.rows[i]] = std::numeric_limits<double>::quiet_NaN();
        fault.limit = std::max(fault.limit, jump);
        ++fault.stretches;
        first = last;
        break;
      }
    if (fault.stretches > stretches) fault.trials.push_back(s.trial->name);
  }
  if (fault.stretches > 0) faults.push_back(std::move(fault));
}

}  // namespace sandhopper::diagnose
