#include <algorithm>
#include <cmath>
#include <limits>

#include "tools/diagnose/recordings/data_fault_parts.hpp"

namespace sandhopper::diagnose {
namespace {

// Limits of this file without a reason beside them were set by hand on campaigns of this project.
constexpr double kIsolated = 0.3;  // a value farther from all others, as a share of their range, is isolated
constexpr double kOften = 2.0;     // least mean number of gaps in trials that have any
constexpr double kManyTrials = 0.5;  // least share of the trials that have gaps
// Lost rows are a fault if at least kShareLost of all rows are lost; if the usual gap has kLongGap rows or
// more, from kShareInLongGaps on.
constexpr double kShareLost = 0.12, kShareInLongGaps = 0.01, kLongGap = 6.0;
constexpr std::size_t kEnough = 3;  // least number of proven dropouts
constexpr double kGauss = 2.5;      // greatest density of a normal distribution: 1 / (2.5 sd)
// Expected number of chance stretches in the campaign, below which one is a dropout.
constexpr double kDropoutsByChance = 0.001;
// Share of the neighbours at the code above which the quantity rests at the code.
constexpr double kSeldomCode = 0.3;

// Values that may mark a lost sample: zero, and an end of the range that is isolated from all other values.
std::vector<double> codes(const std::vector<SampledChannel>& channel) {
  std::vector<double> all;
  for (const auto& s : channel) all.insert(all.end(), s.value.begin(), s.value.end());
  std::sort(all.begin(), all.end());
  std::vector<double> found{0.0};
  const auto after_first = std::upper_bound(all.begin(), all.end(), all.front());
  const auto before_last = std::lower_bound(all.begin(), all.end(), all.back());
  if (after_first == all.end() || before_last == all.begin()) return found;
  const double low_range = all.back() - *after_first, high_range = *(before_last - 1) - all.front();
  if (*after_first - all.front() > kIsolated * low_range && low_range > 0.0) found.push_back(all.front());
  if (all.back() - *(before_last - 1) > kIsolated * high_range && high_range > 0.0)
    found.push_back(all.back());
  return found;
}

// Root mean square of the changes on both sides of a stretch.
double changes_beside(const std::vector<double>& v, std::size_t first, std::size_t last, double code) {
  double sum = 0.0, count = 0.0;
  const auto add = [&](std::size_t i) {
    if (v[i] == code || v[i - 1] == code) return;
    sum += (v[i] - v[i - 1]) * (v[i] - v[i - 1]);
    ++count;
  };
  for (std::size_t i = first > kJumpNeighbours ? first - kJumpNeighbours : 1; i < first; ++i) add(i);
  for (std::size_t i = last + 2; i < std::min(v.size(), last + 2 + kJumpNeighbours); ++i) add(i);
  return count > 0.0 ? std::sqrt(sum / count) : std::numeric_limits<double>::infinity();
}

// True if the channel jumps to the code and then back to about its former value.
bool falls_out(const std::vector<double>& v, std::size_t first, std::size_t last, double code, double noise) {
  if (first == 0 || last + 1 >= v.size()) return false;
  const double before = v[first - 1] - code, after = v[last + 1] - code;
  if (before * after <= 0.0) return false;
  const double far = std::min(std::abs(before), std::abs(after));
  const double change = std::max(noise, changes_beside(v, first, last, code));
  return far > kOutlying * change && std::abs(before - after) < kAlike * far;
}

// Samples from first to last, all at the code.
struct Dropout {
  std::size_t first, last;
  std::size_t samples() const { return last - first + 1; }
};

std::vector<Dropout> stretches_at(const std::vector<double>& v, double code) {
  std::vector<Dropout> found;
  for (std::size_t i = 0; i < v.size(); ++i) {
    if (v[i] != code) continue;
    if (i > 0 && v[i - 1] == code)
      found.back().last = i;
    else
      found.push_back({i, i});
  }
  return found;
}

// True if many neighbours of the stretch are at the code, so that the channel rests there. Neighbours beyond
// an excursion far off the code belong to another stretch and do not count.
bool rests_there(const std::vector<double>& v, const Dropout& s, double code, double noise) {
  double at_code = 0.0, count = 0.0;
  const auto look = [&](std::ptrdiff_t from, std::ptrdiff_t by) {
    bool left = false;
    for (std::size_t n = 0; n < kJumpNeighbours; ++n, from += by) {
      if (from < 0 || from >= static_cast<std::ptrdiff_t>(v.size())) return;
      const double off = std::abs(v[static_cast<std::size_t>(from)] - code);
      if (off == 0.0 && left) return;
      left = left || off > kOutlying * noise;
      at_code += off == 0.0 ? 1.0 : 0.0;
      ++count;
    }
  };
  look(static_cast<std::ptrdiff_t>(s.first) - 1, -1);
  look(static_cast<std::ptrdiff_t>(s.last) + 1, 1);
  return count == 0.0 || at_code > kSeldomCode * count;
}

// Dropouts of one channel. Stretches that are far from their neighbours, or longer than chance explains,
// prove the fault and show how long it lasts. If it is proven, stretches of similar length count as well if
// the quantity is near the code or changes.
std::vector<std::vector<Dropout>> lost_stretches(const std::vector<SampledChannel>& channel, double code,
                                                 bool always_noisy) {
  const double noise = own_noise(channel), grid = value_grid(channel);
  const double still = std::max(noise, 0.5 * grid);  // a reading that reverses near the code is no dropout
  double samples = 0.0;
  for (const auto& s : channel) samples += static_cast<double>(s.value.size());
  // Probability that a sample equals the code by chance: noise spreads over several grid steps.
  const double by_chance = noise > 0.0 ? std::min(1.0, grid / (kGauss * noise)) : 1.0;
  // At the first or last sample no return is visible; the sensor may rest at its limit.
  const auto at_edge = [](const std::vector<double>& v, const Dropout& s) {
    return s.first == 0 || s.last + 1 == v.size();
  };
  const auto lasts = [&](const std::vector<double>& v, const Dropout& s) {
    return always_noisy && !at_edge(v, s) &&
           samples * std::pow(by_chance, static_cast<double>(s.samples())) < kDropoutsByChance &&
           !rests_there(v, s, code, noise);
  };
  std::vector<std::vector<Dropout>> lost(channel.size());
  std::size_t proven = 0, shortest = std::numeric_limits<std::size_t>::max(), longest = 0;
  for (const auto& s : channel)
    for (const auto& stretch : stretches_at(s.value, code))
      if (falls_out(s.value, stretch.first, stretch.last, code, still) || lasts(s.value, stretch)) {
        ++proven;
        shortest = std::min(shortest, stretch.samples());
        longest = std::max(longest, stretch.samples());
      }
  if (proven < kEnough) return lost;
  for (std::size_t c = 0; c < channel.size(); ++c)
    for (const auto& stretch : stretches_at(channel[c].value, code)) {
      const auto& v = channel[c].value;
      const bool as_long =
          stretch.samples() <= longest && (at_edge(v, stretch) || 2 * stretch.samples() >= shortest);
      if (falls_out(v, stretch.first, stretch.last, code, still) || lasts(v, stretch) ||
          (as_long && stretch.samples() > 1 && !rests_there(v, stretch, code, noise)))
        lost[c].push_back(stretch);
    }
  return lost;
}

// True for accelerometers and load cells, which always show noise. An encoder at rest, or a command, may
// repeat one value.
bool always_noisy(const std::string& channel) {
  return channel.find("accel") != std::string::npos || channel.find("force") != std::string::npos;
}

}  // namespace

void find_dropouts(std::vector<Trial>& trials, const std::string& channel, std::vector<DataFault>& faults) {
  auto samples = sampled(trials, channel);
  double total = 0.0;
  for (const auto& s : samples) total += static_cast<double>(s.value.size());
  if (total < 20.0) return;
  for (const double code : codes(samples)) {
    DataFault fault;
    fault.channel = channel;
    fault.id = "data.dropout";
    std::vector<double> lengths;
    const auto lost = lost_stretches(samples, code, always_noisy(channel));
    for (std::size_t c = 0; c < samples.size(); ++c) {
      const auto& s = samples[c];
      auto& values = s.trial->channels[channel];
      double step_s = 1e-3;
      if (s.time_s.size() > 1)
        step_s = (s.time_s.back() - s.time_s.front()) / static_cast<double>(s.time_s.size() - 1);
      fault.step_s = std::max(fault.step_s, step_s);
      if (!s.time_s.empty()) fault.recorded_s += s.time_s.back() - s.time_s.front();
      for (const auto& stretch : lost[c]) {
        lengths.push_back(static_cast<double>(stretch.samples()) * step_s);
        for (std::size_t k = stretch.first; k <= stretch.last; ++k)
          values[s.rows[k]] = std::numeric_limits<double>::quiet_NaN();
      }
      if (!lost[c].empty()) fault.trials.push_back(s.trial->name);
    }
    fault.stretches = lengths.size();
    if (fault.stretches == 0) continue;
    std::sort(lengths.begin(), lengths.end());
    fault.duration_s = lengths[lengths.size() / 2];
    fault.rate_Hz = static_cast<double>(fault.stretches) / std::max(fault.recorded_s, 1e-9);
    faults.push_back(std::move(fault));
    samples = sampled(trials, channel);
  }
}

void find_lost_rows(const std::vector<Trial>& trials, std::vector<DataFault>& faults) {
  DataFault fault;
  fault.id = "data.dropout";
  fault.channel = "t_s";
  std::vector<double> lengths;
  double rows = 0.0, lost = 0.0;
  for (const auto& trial : trials) {
    const auto& t = trial.time_s;
    if (t.size() < 10) continue;
    std::vector<double> steps;
    for (std::size_t i = 1; i < t.size(); ++i) steps.push_back(t[i] - t[i - 1]);
    auto sorted = steps;
    std::sort(sorted.begin(), sorted.end());
    const double step_s = sorted[sorted.size() / 2];
    // Unevenly timed rows are not lost rows.
    if (sorted[sorted.size() * 9 / 10] > 1.2 * step_s || sorted[sorted.size() / 10] < 0.8 * step_s) return;
    bool hit = false;
    for (const double step : steps)
      if (step > 1.6 * step_s) {
        lengths.push_back(step - step_s);
        lost += step / step_s - 1.0;
        hit = true;
      }
    rows += static_cast<double>(t.size());
    fault.recorded_s += t.back() - t.front();
    fault.step_s = step_s;
    if (hit) fault.trials.push_back(trial.name);
  }
  fault.stretches = lengths.size();
  const auto count = static_cast<double>(trials.size());
  const auto hit = static_cast<double>(fault.trials.size());
  if (static_cast<double>(fault.stretches) < kOften * hit || hit < kManyTrials * count || lengths.empty())
    return;
  std::sort(lengths.begin(), lengths.end());
  fault.duration_s = lengths[lengths.size() / 2];
  const bool long_gaps = fault.duration_s > (kLongGap - 0.5) * fault.step_s;
  if (lost < (long_gaps ? kShareInLongGaps : kShareLost) * rows) return;
  fault.rate_Hz = static_cast<double>(fault.stretches) / std::max(fault.recorded_s, 1e-9);
  faults.push_back(std::move(fault));
}

}  // namespace sandhopper::diagnose
