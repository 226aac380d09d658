#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <string_view>
#include <utility>

#include "tools/diagnose/fit/statistics.hpp"
#include "tools/diagnose/recordings/data_fault_parts.hpp"

namespace sandhopper::diagnose {
namespace {

// Limits of this file without a reason beside them were set by hand on campaigns of this project.
constexpr std::size_t kNeighbours = 10;  // samples on each side
// Largest probability of a stretch by chance, from the share of repeats nearby.
constexpr double kByChance = 1e-6;
constexpr double kByChanceOfFast = 1e-5;    // the same for a fast quantity, from the size of its steps
constexpr double kMostRepeats = 0.6;        // share of repeats nearby, above which the sensor rests
constexpr double kCertainStretch_s = 0.06;  // a shorter stretch may also be lost samples
constexpr std::size_t kShortest = 4;        // samples
constexpr std::size_t kShortestOfFast = 3;  // the same for a fast quantity
constexpr double kFast = 50.0;              // grid steps per sample
constexpr double kSeldom = 0.02;  // share of pairs among all runs: a fast quantity repeats less often
// A drive computes its speed from encoder counts, so at constant speed the same value repeats.
constexpr std::size_t kShortestOfSpeed = 10;
constexpr std::string_view kPosition = "position_rad", kSpeed = "velocity_radps";

struct Stretch {
  std::size_t first, last;  // indices of samples
  double duration_s;
};

// Calls visit(i) for the samples within kNeighbours on each side of a stretch that have a predecessor, and
// `ahead` successors, on that side.
template <class Visit>
void each_around(const std::vector<double>& v, std::size_t first, std::size_t last, std::size_t ahead,
                 Visit visit) {
  const auto look = [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from + 1; i + ahead <= to && i + ahead < v.size(); ++i) visit(i);
  };
  if (first > 0) look(first > kNeighbours ? first - kNeighbours : 0, first - 1);
  if (last + 1 < v.size()) look(last + 1, last + kNeighbours);
}

// Share of repeats among the successive samples around a stretch.
double repeats_around(const std::vector<double>& v, std::size_t first, std::size_t last) {
  double equal = 0.5, count = 1.0;
  each_around(v, first, last, 0, [&](std::size_t i) {
    equal += v[i] == v[i - 1] ? 1.0 : 0.0;
    ++count;
  });
  return equal / count;
}

// Root mean square of `change(i)` around a stretch; it looks at samples i - 1 to i + `ahead`.
template <class Change>
double rms_around(const std::vector<double>& v, std::size_t first, std::size_t last, std::size_t ahead,
                  Change change) {
  double sum = 0.0, count = 0.0;
  each_around(v, first, last, ahead, [&](std::size_t i) {
    sum += change(i) * change(i);
    ++count;
  });
  return count > 0.0 ? std::sqrt(sum / count) : 0.0;
}

double changes_around(const std::vector<double>& v, std::size_t first, std::size_t last) {
  return rms_around(v, first, last, 0, [&](std::size_t i) { return v[i] - v[i - 1]; });
}

// Robust standard deviation of the changes around a stretch; single jumps do not count.
double usual_change_around(const std::vector<double>& v, std::size_t first, std::size_t last) {
  std::vector<double> changes;
  each_around(v, first, last, 0, [&](std::size_t i) { changes.push_back(std::abs(v[i] - v[i - 1])); });
  return changes.empty() ? 0.0 : 1.4826 * median(std::move(changes));
}

// Standard deviation of the white noise around a stretch. Second differences suppress the motion of the
// quantity.
double noise_around(const std::vector<double>& v, std::size_t first, std::size_t last) {
  return rms_around(v, first, last, 1,
                    [&](std::size_t i) { return (v[i + 1] - 2.0 * v[i] + v[i - 1]) / std::sqrt(6.0); });
}

// True if the quantity changed during the stretch: its neighbours change by several grid steps, or a long
// stretch lies in noise of more than 1.5 steps, or the value jumps at the end of the stretch.
bool quantity_went_on(const std::vector<double>& v, std::size_t first, std::size_t last, double grid) {
  constexpr std::size_t kMany = 10;
  const double change = changes_around(v, first, last);
  if (change >= 4.0 * grid) return true;
  if (last - first >= kMany && noise_around(v, first, last) >= 1.5 * grid) return true;
  return std::abs(v[last + 1] - v[last]) >= std::max(4.0 * grid, 3.0 * change);
}

// True if the first change after the stretch is at least twice the next one, and two grid steps. A stuck
// sensor jumps to the present value; after a real pause the motion starts slowly.
bool jumps_after(const std::vector<double>& v, std::size_t last, double grid) {
  if (last + 2 >= v.size()) return true;
  return std::abs(v[last + 1] - v[last]) >= 2.0 * std::max(std::abs(v[last + 2] - v[last + 1]), grid);
}

// True if the quantity moves by more than its noise from sample to sample: white noise changes by sqrt(2) of
// its standard deviation, and half of that ratio is motion.
bool moves_smoothly(const std::vector<double>& v, std::size_t first, std::size_t last) {
  return noise_around(v, first, last) < 0.5 * changes_around(v, first, last) / std::numbers::sqrt2;
}

// Share of repeats of this value elsewhere in the trial. The share of all values, `of_any`, counts like two
// more samples.
double repeats_of_value(const std::vector<double>& v, std::size_t first, std::size_t last, double of_any) {
  double pairs = 2.0 * of_any, count = 2.0;
  for (std::size_t i = 0; i + 1 < v.size(); ++i)
    if (v[i] == v[first] && (i < first || i > last)) {
      pairs += v[i + 1] == v[i] ? 1.0 : 0.0;
      ++count;
    }
  return pairs / count;
}

// Properties of the whole channel.
struct HeldIn {
  std::size_t shortest, shortest_by_number;  // samples
  double chance_anywhere, resolution;        // probability of a repeat; smallest difference of values
  bool quiet;                                // noise below one grid step
};

std::vector<Stretch> held_stretches(const std::vector<double>& v, const std::vector<double>& t,
                                    const HeldIn& channel) {
  const auto& [shortest, shortest_by_number, chance_anywhere, resolution, quiet] = channel;
  std::vector<Stretch> found;
  double grid = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < v.size(); ++i)
    if (v[i] != v[i - 1]) grid = std::min(grid, std::abs(v[i] - v[i - 1]));
  for (std::size_t i = 0; i < v.size();) {
    std::size_t j = i;
    while (j + 1 < v.size() && v[j + 1] == v[i]) ++j;
    const std::size_t length = j - i + 1;
    const bool inside = i > 0 && j + 1 < v.size();
    if (length < kShortestOfFast || !inside) {
      i = j + 1;
      continue;
    }
    // Steps of many times the resolution meet the same value again with this probability.
    const double steps = usual_change_around(v, i, j) / resolution;
    const bool fast = steps > kFast && chance_anywhere < kSeldom && shortest == kShortest;
    double chance = std::max(repeats_around(v, i, j), chance_anywhere);
    chance = fast ? 1.0 / (std::sqrt(2.0 * std::numbers::pi) * steps)
                  : std::max(chance, repeats_of_value(v, i, j, chance));
    // A value of exactly 0 is a drive at rest.
    if (v[i] != 0.0 && length >= (fast ? kShortestOfFast : shortest) && chance < kMostRepeats &&
        (std::pow(chance, static_cast<double>(length - 1)) < (fast ? kByChanceOfFast : kByChance) ||
         length >= shortest_by_number) &&
        quantity_went_on(v, i, j, grid) && (!(quiet || moves_smoothly(v, i, j)) || jumps_after(v, j, grid)))
      found.push_back({i, j, t[j] - t[i]});
    i = j + 1;
  }
  return found;
}

// Stretches at the first or last sample. They have neighbours on one side only, so they count if they have at
// least `shortest` samples: half of the shortest other stretch.
std::vector<Stretch> stretches_at_the_ends(const std::vector<double>& v, const std::vector<double>& t,
                                           std::size_t shortest) {
  std::vector<Stretch> found;
  if (v.size() < 2 * shortest) return found;
  std::size_t first = 0, last = v.size() - 1;
  while (first + 1 < v.size() && v[first + 1] == v[0]) ++first;
  while (last > 0 && v[last - 1] == v.back()) --last;
  if (first + 1 >= shortest && v[0] != 0.0) found.push_back({0, first, t[first] - t[0]});
  if (v.size() - last >= shortest && v.back() != 0.0 && last > first)
    found.push_back({last, v.size() - 1, t.back() - t[last]});
  return found;
}

// Runs of equal values in all trials of a channel, and its range.
struct Runs {
  std::map<std::size_t, double> by_length;          // number of runs by their length, from two samples on
  double all = 0.0, repeated = 0.0, samples = 0.0;  // runs, repeated samples, samples
  double low = 1e300, high = -1e300;

  double count(std::size_t length) const {
    const auto it = by_length.find(length);
    return it == by_length.end() ? 0.0 : it->second;
  }
};

Runs runs_of(const std::vector<SampledChannel>& samples) {
  Runs runs;
  for (const auto& s : samples) {
    for (std::size_t i = 0; i < s.value.size();) {
      std::size_t j = i;
      while (j + 1 < s.value.size() && s.value[j + 1] == s.value[i]) ++j;
      runs.low = std::min(runs.low, s.value[i]);
      runs.high = std::max(runs.high, s.value[i]);
      if (j > i) ++runs.by_length[j - i + 1];
      ++runs.all;
      runs.repeated += static_cast<double>(j - i);
      i = j + 1;
    }
    runs.samples += static_cast<double>(s.value.size());
  }
  return runs;
}

// Length from which runs are too frequent for chance: chance repeats follow a geometric law and become rarer
// with length.
std::size_t shortest_by_number(const Runs& runs) {
  const double ratio = std::clamp((runs.count(3) + 1.0) / (runs.count(2) + 2.0), 0.02, 0.6);
  for (std::size_t length = kShortest + 1; length < 200; ++length) {
    const double expected = (runs.count(2) + 1.0) * std::pow(ratio, static_cast<double>(length - 2));
    if (runs.count(length) >= 4.0 + 8.0 * expected && runs.count(length) > 2.0 * runs.count(length - 1))
      return length;
  }
  return std::numeric_limits<std::size_t>::max();
}

// True if a constant speed is real: the position moved by speed times duration, within 2 %.
bool position_went_along(const SampledChannel& speed, const std::string& channel, const Stretch& stretch) {
  constexpr double kAgree = 0.02;  // relative
  if (!channel.ends_with(kSpeed)) return false;
  const auto* position =
      speed.trial->find(channel.substr(0, channel.size() - kSpeed.size()).append(kPosition));
  if (position == nullptr) return false;
  const double moved = (*position)[speed.rows[stretch.last]] - (*position)[speed.rows[stretch.first]];
  const double said = speed.value[stretch.first] * stretch.duration_s;
  return std::abs(moved - said) < kAgree * std::abs(said);
}

// Speed channel of the same encoder; null if `channel` is no position.
const std::vector<double>* speed_of(const SampledChannel& position, const std::string& channel) {
  if (!channel.ends_with(kPosition)) return nullptr;
  return position.trial->find(channel.substr(0, channel.size() - kPosition.size()).append(kSpeed));
}

// True if a constant position is real: its speed is only noise around zero.
bool speed_was_none(const SampledChannel& position, const std::string& channel, const Stretch& stretch) {
  // Least number of samples; largest variance over that of white noise; largest mean in standard errors.
  constexpr double kEnough = 8.0, kWhite = 2.0, kSigma = 4.0;
  const auto* speed = speed_of(position, channel);
  if (speed == nullptr) return false;
  double n = 0.0, mean = 0.0, squares = 0.0, changes = 0.0, last = 0.0;
  double step = std::numeric_limits<double>::infinity();  // smallest change of the speed: its rounding
  for (std::size_t k = stretch.first; k <= stretch.last; ++k) {
    const double v = (*speed)[position.rows[k]];
    if (!std::isfinite(v)) continue;
    if (n > 0.0) changes += (v - last) * (v - last);
    if (n > 0.0 && v != last) step = std::min(step, std::abs(v - last));
    last = v;
    ++n;
    mean += v;
    squares += v * v;
  }
  if (n < kEnough) return false;
  mean /= n;
  // The mean square of successive differences of white noise is twice its variance.
  const double noise = changes / (2.0 * (n - 1.0)), scatter = squares / n - mean * mean;
  const bool none = std::abs(mean) < step || n * mean * mean < kSigma * kSigma * noise;
  return changes > 0.0 && none && scatter < kWhite * noise;
}

constexpr double kCounts = 2.5;  // in encoder counts: a motion below this may be noise

// True if the integrated speed is below kCounts: near a reversal an encoder shows one count for a while.
bool within_a_count(const SampledChannel& position, const std::string& channel, const Stretch& stretch) {
  const auto* speed = speed_of(position, channel);
  if (speed == nullptr) return false;
  double moved = 0.0;
  for (std::size_t k = stretch.first; k <= stretch.last; ++k) {
    const double v = (*speed)[position.rows[k]];
    if (!std::isfinite(v)) return false;
    moved += v / static_cast<double>(stretch.last - stretch.first + 1) * stretch.duration_s;
  }
  return std::abs(moved) < kCounts * value_grid({position});
}

// True if the encoder of the other motor stood still, too: both motors move the same leg.
bool other_motor_stood(const SampledChannel& position, const std::string& channel, const Stretch& stretch) {
  if (!channel.ends_with(kPosition)) return false;
  std::string other = channel;
  if (const auto left = other.find("left"); left != std::string::npos)
    other.replace(left, 4, "right");
  else if (const auto right = other.find("right"); right != std::string::npos)
    other.replace(right, 5, "left");
  const auto* values = position.trial->find(other);
  if (other == channel || values == nullptr) return false;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (std::size_t k = stretch.first; k <= stretch.last; ++k) {
    const double v = (*values)[position.rows[k]];
    if (!std::isfinite(v)) return false;
    low = std::min(low, v);
    high = std::max(high, v);
  }
  return high - low < kCounts * value_grid({position});
}

// Smallest difference of any two values of a channel. Successive samples may all be far apart.
double resolution_of(const std::vector<SampledChannel>& channel) {
  std::vector<double> values;
  for (const auto& s : channel) values.insert(values.end(), s.value.begin(), s.value.end());
  std::ranges::sort(values);
  double resolution = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < values.size(); ++i)
    if (const double step = values[i] - values[i - 1]; step > 1e-9 * std::abs(values[i]))
      resolution = std::min(resolution, step);
  return resolution;
}
// A stuck stretch in one trial.
struct Held {
  const SampledChannel* samples;
  Stretch stretch;

  std::size_t length() const { return stretch.last - stretch.first + 1; }
};

// Stuck stretches of all trials that neither the ends of the range nor other channels explain.
std::vector<Held> held_in_all(const std::vector<SampledChannel>& samples, const std::string& channel,
                              const Runs& runs) {
  // The probability of a repeat comes from runs of two. With coarse steps they are frequent by chance, also
  // where a neighbourhood shows none; a stuck stretch adds to the long runs only.
  const HeldIn in{channel.ends_with(kSpeed) ? kShortestOfSpeed : kShortest, shortest_by_number(runs),
                  runs.count(2) / runs.all, resolution_of(samples), own_noise(samples) < value_grid(samples)};
  std::vector<Held> held;
  for (const auto& s : samples)
    for (const auto& stretch : held_stretches(s.value, s.time_s, in)) {
      // A stretch at an end of the range is clipping, another fault.
      if (s.value[stretch.first] >= runs.high || s.value[stretch.first] <= runs.low) continue;
      if (position_went_along(s, channel, stretch) || speed_was_none(s, channel, stretch) ||
          within_a_count(s, channel, stretch) || other_motor_stood(s, channel, stretch))
        continue;
      held.push_back({&s, stretch});
    }
  return held;
}

// True if the stretches are too few or too short to prove a fault.
bool come_by_chance(const std::vector<Held>& held, const std::string& channel, double samples) {
  std::size_t longest = 0;
  for (const auto& one : held) longest = std::max(longest, one.length());
  // A single stretch may be a pause of the drive that moves the foot.
  if (held.size() < 2 && (longest < 8 || channel == "foot_z_m")) return true;
  // A long recording contains some of the shortest stretches by chance.
  const double by_chance = kByChanceOfFast * samples;
  return longest == kShortestOfFast &&
         static_cast<double>(held.size()) < by_chance + 3.0 * std::sqrt(by_chance) + 1.0;
}

// Empties the stretches and counts them.
void empty_stretches(const std::vector<SampledChannel>& samples, const std::vector<Held>& held,
                     DataFault& fault) {
  const auto take = [&](const SampledChannel& s, const Stretch& stretch) {
    auto& values = s.trial->channels[fault.channel];
    for (std::size_t k = stretch.first + 1; k <= stretch.last; ++k)
      values[s.rows[k]] = std::numeric_limits<double>::quiet_NaN();
    if (fault.trials.empty() || fault.trials.back() != s.trial->name) fault.trials.push_back(s.trial->name);
    ++fault.stretches;
  };
  std::size_t least = std::numeric_limits<std::size_t>::max();
  for (const auto& one : held) {
    take(*one.samples, one.stretch);
    least = std::min(least, one.length());
  }
  if (held.size() > 1)
    for (const auto& s : samples)
      for (const auto& stretch : stretches_at_the_ends(s.value, s.time_s, std::max(kShortest, least / 2)))
        take(s, stretch);
  std::sort(fault.trials.begin(), fault.trials.end());
  fault.trials.erase(std::unique(fault.trials.begin(), fault.trials.end()), fault.trials.end());
}

}  // namespace

void find_stuck(std::vector<Trial>& trials, const std::string& channel, std::vector<DataFault>& faults) {
  const auto samples = sampled(trials, channel);
  const Runs runs = runs_of(samples);
  // A slow sensor whose values the log repeats.
  if (runs.samples < 20.0 || runs.repeated > 0.5 * runs.samples) return;
  const auto held = held_in_all(samples, channel, runs);
  if (come_by_chance(held, channel, runs.samples)) return;
  DataFault fault{.channel = channel, .id = "data.stuck", .trials = {}};
  for (const auto& s : samples) {
    if (s.time_s.size() < 2) continue;
    fault.recorded_s += s.time_s.back() - s.time_s.front();
    fault.step_s = (s.time_s.back() - s.time_s.front()) / static_cast<double>(s.time_s.size() - 1);
  }
  empty_stretches(samples, held, fault);
  std::vector<double> durations;
  for (const auto& one : held) durations.push_back(one.stretch.duration_s);
  std::sort(durations.begin(), durations.end());
  fault.duration_s = durations[durations.size() / 2];
  // No stretch begins while another lasts, so the rate refers to the remaining time.
  const double free_s = fault.recorded_s - static_cast<double>(fault.stretches) * fault.duration_s;
  fault.rate_Hz = free_s > 0.0 ? static_cast<double>(fault.stretches) / free_s : 0.0;
  fault.borderline = fault.stretches < 2 || fault.duration_s < kCertainStretch_s;
  faults.push_back(std::move(fault));
}

}  // namespace sandhopper::diagnose
