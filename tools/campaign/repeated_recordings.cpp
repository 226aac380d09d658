#include "tools/campaign/repeated_recordings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

namespace sandhopper {
namespace {

constexpr std::uint64_t kOffset = 14695981039346656037ULL, kPrime = 1099511628211ULL;  // FNV-1a, 64 bits

void take_byte(std::uint64_t& hash, unsigned char byte) { hash = (hash ^ byte) * kPrime; }

void take_number(std::uint64_t& hash, double value) {
  unsigned char bytes[sizeof value];
  std::memcpy(bytes, &value, sizeof value);
  for (const auto byte : bytes) take_byte(hash, byte);
}

// True if the values show noise of at least one step of their resolution. Two measurements then agree in a
// sample with a probability below 1 / 2.5 (the greatest density of a normal distribution times the step), in
// 50 samples with 1e-20. Of white noise successive second differences are correlated by -2/3, of a smooth
// course (a simulation, a formula) by nearly 1: the limit lies between noise and none.
bool shows_noise(const std::vector<double>& values) {
  constexpr std::size_t kFewestSamples = 50;
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

bool is_unmistakable(const TrialRecording& recording) {
  return std::ranges::any_of(recording.channels,
                             [](const auto& channel) { return shows_noise(channel.values); });
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

std::uint64_t fingerprint_of(const TrialRecording& recording) {
  if (!recording.usable() || !is_unmistakable(recording)) return 0;
  std::uint64_t hash = kOffset;
  for (const auto& channel : recording.channels) {
    for (const char c : channel.name) take_byte(hash, static_cast<unsigned char>(c));
    for (const double value : channel.values)
      if (!std::isnan(value)) take_number(hash, value);
  }
  return hash == 0 ? 1 : hash;
}

std::optional<Finding> RepeatedRecordings::add(const CampaignTrial& trial, std::uint64_t fingerprint) {
  if (fingerprint == 0) return std::nullopt;
  const auto [place, is_new] = first_.emplace(fingerprint, &trial);
  if (is_new) return std::nullopt;
  const auto& first = *place->second;
  const bool is_one_file = first.file == trial.file;
  return Finding{
      FindingKind::set_up,
      FindingSeverity::trial_unusable,
      trial.file.string(),
      1,
      1,
      fmt::format("trial {}", trial.entry),
      fmt::format("has the same samples as trial {}{}: it is one recording, and is counted once{}",
                  first.entry, is_one_file ? "" : fmt::format(" ({})", first.name),
                  is_same_set_up(first, trial)
                      ? ""
                      : ", with the set-up of the first; the set-ups differ, so one of them is wrong"),
      "name the recording that was meant, or take this [[trial]] away"};
}

}  // namespace sandhopper
