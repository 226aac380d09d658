#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/special_functions/erf.hpp>
#include <cmath>
#include <limits>

#include "tools/diagnose/fit/levels.hpp"
#include "tools/diagnose/fit/statistics.hpp"
#include "tools/diagnose/recordings/data_fault_parts.hpp"

namespace sandhopper::diagnose {
namespace {

// Limits of this file without a reason beside them were set by hand on campaigns of this project.
constexpr double kPileUp = 0.01;     // least share of all samples that equal the end value
constexpr std::size_t kLeast = 6;    // least number of samples there
constexpr std::size_t kFewest = 10;  // least number of samples for the noise of a trial
// Least number of successive pairs there, if the share is smaller: an impact is short.
constexpr std::size_t kInARow = 4;
// Least noise in grid steps; with less noise, equal samples alone prove nothing.
constexpr double kGridSteps = 3.0;
// In standard deviations: noise may move a clipped sample off the limit by this.
constexpr double kLifted = 3.0;
constexpr std::ptrdiff_t kAround = 12;  // samples on each side, whose median estimates the quantity
constexpr std::ptrdiff_t kBeside = 2;   // samples on each side of a clipped one that may be clipped, too

// An accelerometer clips; the other sensors saturate.
std::string range_fault(const std::string& channel) {
  return channel.starts_with("imu_") ? "imu.clipping" : "sensor.saturation";
}

// Noise of the samples that are not at the ends of the range; clipped samples show none.
double noise_off(const std::vector<SampledChannel>& samples, double low, double high) {
  auto inside = samples;
  for (auto& s : inside) {
    std::vector<double> values, times_s;
    for (std::size_t i = 0; i < s.value.size(); ++i)
      if (s.value[i] != low && s.value[i] != high) {
        values.push_back(s.value[i]);
        times_s.push_back(s.time_s[i]);
      }
    s.value = std::move(values);
    s.time_s = std::move(times_s);
  }
  std::erase_if(inside, [](const SampledChannel& s) { return s.value.size() < kFewest; });
  return own_noise(inside);
}

// Indices of samples that may be clipped. `beyond`: sample minus limit, at most 0. For a slow quantity the
// median of the neighbours decides, not the sample itself. Otherwise samples that noise moved down from the
// limit would stay, and would bias the quantity.
std::vector<std::size_t> near_limit(const std::vector<double>& beyond, double noise) {
  const auto n = static_cast<std::ptrdiff_t>(beyond.size());
  const auto at = [&](std::ptrdiff_t i) { return beyond[static_cast<std::size_t>(i)]; };
  std::vector<std::size_t> near;
  for (std::ptrdiff_t i = 0; i < n; ++i) {
    bool cut = false;
    for (std::ptrdiff_t k = std::max<std::ptrdiff_t>(0, i - kBeside); k <= std::min(n - 1, i + kBeside); ++k)
      cut = cut || (at(k) == 0.0 && at(i) > -kLifted * noise);
    if (!cut && at(i) > -2.0 * kLifted * noise) {
      const auto reach = std::min({kAround, i, n - 1 - i});
      cut = median({beyond.begin() + (i - reach), beyond.begin() + (i + reach + 1)}) > -kLifted * noise;
    }
    if (cut) near.push_back(static_cast<std::size_t>(i));
  }
  return near;
}

// Fault of a channel that shows one value in all trials: it is at the end of its range all the time, not
// stuck. Its samples are emptied.
DataFault always_at_its_end(const std::vector<SampledChannel>& samples, const std::string& channel,
                            double value) {
  DataFault always{.channel = channel,
                   .id = range_fault(channel),
                   .stretches = samples.size(),
                   .limit = value,
                   .borderline = true,
                   .trials = {}};
  for (const auto& s : samples) {
    always.trials.push_back(s.trial->name);
    for (const std::size_t row : s.rows)
      s.trial->channels[channel][row] = std::numeric_limits<double>::quiet_NaN();
  }
  return always;
}

bool shows_one_value(const SampledChannel& s) {
  return std::ranges::all_of(s.value, [&](double v) { return v == s.value.front(); });
}

// True if noise could not leave so many samples in one step of the grid: each follows its predecessor there
// with a probability of at most erf(grid / (2 sqrt(2) noise)), that of a step in the middle of the noise.
bool noise_is_missing(double at_end, std::size_t in_a_row, double noise, double grid) {
  if (!(noise > 0.0) || in_a_row == 0) return false;
  const boost::math::binomial repeats(at_end, boost::math::erf(grid / (2.0 * std::sqrt(2.0) * noise)));
  return boost::math::cdf(boost::math::complement(repeats, static_cast<double>(in_a_row - 1))) < kBeyondDoubt;
}

// True if the channel jumps to this value from another value that stands still, and from it to such a value:
// a step of a command. A clipped quantity approaches its limit, or its noise shows beside it.
bool is_stepped_to(const std::vector<SampledChannel>& samples, double end) {
  std::size_t steps = 0;
  for (const auto& s : samples) {
    const auto& v = s.value;
    for (std::size_t i = 1; i < v.size(); ++i) {
      const bool enters = v[i] == end && v[i - 1] != end, leaves = v[i] != end && v[i - 1] == end;
      if (!enters && !leaves) continue;
      if (enters && i >= 2 && v[i - 1] != v[i - 2]) return false;
      if (leaves && i + 1 < v.size() && v[i] != v[i + 1]) return false;
      ++steps;
    }
  }
  return steps > 0;
}

// The largest or smallest value of the channel, if samples pile up there; the one of larger magnitude if they
// do at both. 0: no limit. A trial of one value shows no limit: its torque may be that of a weight.
double limit_of(const std::vector<SampledChannel>& samples, double low, double high, double total,
                double noise, double grid) {
  double limit = 0.0;
  for (const double end : {high, low}) {
    double at_end = 0.0, next = 0.0;
    std::size_t in_a_row = 0;
    for (const auto& s : samples) {
      if (shows_one_value(s)) continue;
      for (std::size_t i = 0; i < s.value.size(); ++i) {
        const double v = s.value[i];
        at_end += v == end ? 1.0 : 0.0;
        in_a_row += i > 0 && v == end && s.value[i - 1] == end;
        next += v != end && std::abs(v - end) < 4.5 * grid ? 1.0 : 0.0;
      }
    }
    // Without a limit the end value is not more frequent than the four grid steps next to it.
    if (at_end < static_cast<double>(kLeast) || at_end < 3.0 * (next + 1.0)) continue;
    if (at_end < kPileUp * total && in_a_row < kInARow) continue;
    if (noise < kGridSteps * grid && !noise_is_missing(at_end, in_a_row, noise, grid)) continue;
    if (limit != 0.0 && std::abs(end) < std::abs(limit)) continue;
    if (is_stepped_to(samples, end)) continue;
    limit = end;
  }
  return limit;
}

// Empties the samples at the limit; at both ends if the range is symmetric.
void empty_at_limit(const std::vector<SampledChannel>& samples, double low, double high, double noise,
                    DataFault& fault) {
  for (const auto& s : samples) {
    auto& values = s.trial->channels[fault.channel];
    bool hit = false;
    for (const double sign : {1.0, -1.0}) {
      if (!fault.at_both_ends && fault.limit != (sign > 0.0 ? high : low)) continue;
      std::vector<double> beyond;
      for (const double v : s.value) beyond.push_back(sign > 0.0 ? v - high : low - v);
      hit = hit || std::ranges::find(beyond, 0.0) != beyond.end();
      for (const std::size_t i : near_limit(beyond, noise))
        values[s.rows[i]] = std::numeric_limits<double>::quiet_NaN();
    }
    if (hit) {
      fault.trials.push_back(s.trial->name);
      ++fault.stretches;
    }
  }
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
  if (total >= 50.0 && high == low && high != 0.0 && samples.size() > 1) {
    faults.push_back(always_at_its_end(samples, channel, high));
    return;
  }
  if (total < 50.0 || !(high > low)) return;
  const double noise = noise_off(samples, low, high), grid = value_grid(samples);
  DataFault fault{.channel = channel,
                  .id = range_fault(channel),
                  .limit = limit_of(samples, low, high, total, noise, grid),
                  .at_both_ends = high == -low,
                  .limit_resolution = 0.5 * grid,
                  .trials = {}};
  if (fault.limit == 0.0) return;
  empty_at_limit(samples, low, high, noise, fault);
  faults.push_back(std::move(fault));
}

}  // namespace sandhopper::diagnose
