#include "tools/campaign/repeated_recordings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "tools/campaign/signal_noise.hpp"

namespace sandhopper {
namespace {

constexpr std::uint64_t kOffset = 14695981039346656037ULL, kPrime = 1099511628211ULL;  // FNV-1a, 64 bits

void take_byte(std::uint64_t& hash, unsigned char byte) { hash = (hash ^ byte) * kPrime; }

void take_number(std::uint64_t& hash, double value) {
  unsigned char bytes[sizeof value];
  std::memcpy(bytes, &value, sizeof value);
  for (const auto byte : bytes) take_byte(hash, byte);
}

constexpr std::size_t kFewestSamples = 50;

std::ptrdiff_t place_of_largest(const std::vector<double>& values) {
  return std::ranges::max_element(values, {}, [](double value) { return std::abs(value); }) - values.begin();
}

// True if the values show noise of at least one step of their resolution. Two measurements then agree in a
// sample with a probability below 1 / 2.5 (the greatest density of a normal distribution times the step), in
// 50 samples with 1e-20. Of white noise successive second differences are correlated by -2/3, of a smooth
// course (a simulation, a formula) by nearly 1: the limit lies between noise and none.
bool shows_noise(const std::vector<double>& values) {
  constexpr double kNoisy = -1.0 / 3.0, kOfNoise = 6.0;  // a second difference has the variance of 6 samples
  std::vector<double> v;
  for (const double value : values)
    if (!std::isnan(value)) v.push_back(value);
  if (v.size() < kFewestSamples) return false;
  double grid = std::numeric_limits<double>::infinity(), squares = 0.0, products = 0.0, before = 0.0;
  for (std::size_t i = 1; i + 1 < v.size(); ++i) {
    const double step = std::abs(v[i] - v[i - 1]), bend = v[i + 1] - 2.0 * v[i] + v[i - 1];
    // Equal numbers may differ by the rounding of their scale and offset.
    if (step > 1e-9 * std::abs(v[i])) grid = std::min(grid, step);
    squares += bend * bend, products += bend * before;
    before = bend;
  }
  const double noise = std::sqrt(squares / (kOfNoise * static_cast<double>(v.size() - 2)));
  return noise >= grid && products < kNoisy * squares;
}

// So many samples beside the largest one recognise a recording.
constexpr std::size_t kMostBeside = 2000;

ChannelPart around_largest(const TrialRecording& recording, const TrialRecording::Channel& channel) {
  ChannelPart all{channel.name, {}, {}};
  for (std::size_t row = 0; row < channel.values.size(); ++row)
    if (!std::isnan(channel.values[row]))
      all.t_s.push_back(recording.t_s[row]), all.values.push_back(channel.values[row]);
  const auto size = static_cast<std::ptrdiff_t>(all.values.size());
  constexpr auto kBeside = static_cast<std::ptrdiff_t>(kMostBeside);
  const auto at = place_of_largest(all.values);
  for (auto* numbers : {&all.t_s, &all.values}) {
    numbers->erase(numbers->begin() + std::min(size, at + kBeside + 1), numbers->end());
    numbers->erase(numbers->begin(), numbers->begin() + std::max<std::ptrdiff_t>(0, at - kBeside));
  }
  return all;
}

// The values of one channel, and of another one on the line between its samples, at the times of the first.
struct Paired {
  std::vector<double> values, others;
};

// `lag_s`: what the clock of `other` is behind that of `channel`.
Paired paired(const ChannelPart& channel, const ChannelPart& other, double lag_s) {
  Paired out;
  std::size_t after = 1;
  for (std::size_t i = 0; i < channel.t_s.size(); ++i) {
    const double at_s = channel.t_s[i] - lag_s;
    while (after + 1 < other.t_s.size() && other.t_s[after] < at_s) ++after;
    const double from_s = other.t_s[after - 1], to_s = other.t_s[after];
    // A difference of the two clocks is rounded.
    const double rounding_s = 1e-6 * (to_s - from_s);
    if (!(to_s > from_s) || at_s < from_s - rounding_s || at_s > to_s + rounding_s) continue;
    out.values.push_back(channel.values[i]);
    out.others.push_back(
        std::lerp(other.values[after - 1], other.values[after], (at_s - from_s) / (to_s - from_s)));
  }
  return out;
}

// The difference of two independent signals has sqrt(2) of the noise of one, that of a signal and its copy
// only the rounding. The limit lies between.
bool is_one_noise(std::span<const double> values, std::span<const double> others) {
  constexpr double kOfOne = 0.5;
  std::vector<double> apart;
  for (std::size_t i = 0; i < values.size(); ++i) apart.push_back(values[i] - others[i]);
  return noise_of_bends(apart) < kOfOne * noise_of_bends(values);
}

// The times that one event may have in the two recordings: the same, the first, the last, the largest sample.
std::array<double, 4> lags_of(const ChannelPart& a, const ChannelPart& b) {
  const auto largest_s = [](const ChannelPart& c) {
    return c.t_s[static_cast<std::size_t>(place_of_largest(c.values))];
  };
  return {0.0, a.t_s.front() - b.t_s.front(), a.t_s.back() - b.t_s.back(), largest_s(a) - largest_s(b)};
}

bool is_one_noise_at(const ChannelPart& channel, const ChannelPart& other, double lag_s) {
  const auto [values, others] = paired(channel, other, lag_s);
  if (values.size() < std::max(kFewestSamples, channel.values.size() / 2)) return false;
  // Most pairs differ everywhere, so that the middle is enough to tell.
  const std::size_t begin = (values.size() - kFewestSamples) / 2;
  return is_one_noise(std::span(values).subspan(begin, kFewestSamples),
                      std::span(others).subspan(begin, kFewestSamples)) &&
         is_one_noise(values, others);
}

double mean_step_s(const ChannelPart& c) {
  return (c.t_s.back() - c.t_s.front()) / static_cast<double>(c.t_s.size() - 1);
}

// Delay of the clock of `b` against that of `a`, if both share their noise.
std::optional<double> lag_with_one_noise(const ChannelPart& a, const ChannelPart& b) {
  const bool is_finer = mean_step_s(b) <= mean_step_s(a) * (1.0 + 1e-9);
  for (const double lag_s : lags_of(a, b)) {
    const bool shorter = is_one_noise_at(is_finer ? a : b, is_finer ? b : a, is_finer ? lag_s : -lag_s);
    if (shorter || is_one_noise_at(is_finer ? b : a, is_finer ? a : b, is_finer ? -lag_s : lag_s))
      return lag_s;
  }
  return std::nullopt;
}

// True if two smooth channels differ by more than their steps and the error of the line between two samples,
// 1/8 of the largest second difference. A zero of their own does not count. A command can be the same in two
// recordings; what moved then differs.
bool differs(const ChannelPart& a, const ChannelPart& b, double lag_s) {
  if (a.t_s.size() < 3 || b.t_s.size() < 3) return false;
  const auto [values, others] = paired(a, b, lag_s);
  if (values.size() < kFewestSamples) return false;
  double sum = 0.0, squares = 0.0, bend = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    sum += values[i] - others[i];
    squares += (values[i] - others[i]) * (values[i] - others[i]);
  }
  for (std::size_t i = 1; i + 1 < b.values.size(); ++i)
    bend = std::max(bend, std::abs(b.values[i + 1] - 2.0 * b.values[i] + b.values[i - 1]));
  const auto n = static_cast<double>(values.size());
  const double rms = std::sqrt(std::max(0.0, squares / n - sum * sum / (n * n)));
  return rms > digit_of(a.values) + digit_of(b.values) + bend / 8.0;
}

const ChannelPart* part_of(const std::vector<ChannelPart>& parts, const std::string& name) {
  const auto part = std::ranges::find(parts, name, &ChannelPart::name);
  return part == parts.end() ? nullptr : &*part;
}

bool is_same_set_up(const CampaignTrial& a, const CampaignTrial& b) {
  const auto states = [](const CampaignTrial& in, const SetupEntry& entry) {
    return std::ranges::any_of(in.setup, [&](const SetupEntry& other) {
      return other.key == entry.key && other.value == entry.value;
    });
  };
  return a.kind == b.kind && a.setup.size() == b.setup.size() &&
         std::ranges::all_of(a.setup, [&](const SetupEntry& entry) { return states(b, entry); });
}

}  // namespace

bool have_one_noise(const Fingerprint& a, const Fingerprint& b) {
  std::optional<double> lag_s;
  for (const auto& channel : a.noisy) {
    const auto* other = part_of(b.noisy, channel.name);
    if (other == nullptr) continue;
    lag_s = lag_with_one_noise(channel, *other);
    if (!lag_s) return false;
  }
  if (!lag_s) return false;
  return std::ranges::none_of(a.smooth, [&](const ChannelPart& channel) {
    const auto* other = part_of(b.smooth, channel.name);
    return other != nullptr && differs(channel, *other, *lag_s);
  });
}

Fingerprint fingerprint_of(const TrialRecording& recording) {
  Fingerprint print;
  if (!recording.usable()) return print;
  for (const auto& channel : recording.channels)
    (shows_noise(channel.values) ? print.noisy : print.smooth).push_back(around_largest(recording, channel));
  if (print.noisy.empty()) return print;
  std::uint64_t hash = kOffset;
  for (const auto& channel : recording.channels) {
    for (const char c : channel.name) take_byte(hash, static_cast<unsigned char>(c));
    for (const double value : channel.values)
      if (!std::isnan(value)) take_number(hash, value);
  }
  print.exact = hash == 0 ? 1 : hash;
  return print;
}

std::optional<Finding> RepeatedRecordings::add(const CampaignTrial& trial, Fingerprint fingerprint) {
  if (fingerprint.exact == 0) return std::nullopt;
  bool is_equal = true;
  auto known = std::ranges::find_if(
      known_, [&](const Known& other) { return other.fingerprint.exact == fingerprint.exact; });
  if (known == known_.end()) {
    is_equal = false;
    known = std::ranges::find_if(
        known_, [&](const Known& other) { return have_one_noise(other.fingerprint, fingerprint); });
  }
  if (known == known_.end()) {
    known_.push_back({std::move(fingerprint), &trial});
    return std::nullopt;
  }
  const auto& first = *known->trial;
  const bool is_one_file = first.file == trial.file;
  const auto name =
      fmt::format("trial {}{}", first.entry, is_one_file ? "" : fmt::format(" ({})", first.name));
  return Finding{
      FindingKind::set_up,
      FindingSeverity::trial_unusable,
      trial.file.string(),
      1,
      1,
      fmt::format("trial {}", trial.entry),
      fmt::format("has {} {}: it is one recording{}, and is counted once{}",
                  is_equal ? "the same samples as" : "the noise of", name,
                  is_equal ? "" : " with other digits, rows, ends, zero or clock",
                  is_same_set_up(first, trial)
                      ? ""
                      : ", with the set-up of the first; the set-ups differ, so one of them is wrong"),
      "name the recording that was meant, or take this [[trial]] away"};
}

}  // namespace sandhopper
