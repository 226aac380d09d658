#include "tools/campaign/alternating_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

#include "tools/campaign/force_at_depth.hpp"
#include "tools/campaign/implausible.hpp"
#include "tools/campaign/signal_noise.hpp"

namespace sandhopper {
namespace {

// Samples `first` to `last` of a signal, in which each step turns the other way than the one before.
struct Turns {
  std::size_t first = 0, last = 0;
  std::size_t size() const { return last - first + 1; }
};

Turns longest_turns(const std::vector<double>& values) {
  Turns best, now;
  for (std::size_t i = 2; i < values.size(); ++i) {
    if ((values[i] - values[i - 1]) * (values[i - 1] - values[i - 2]) < 0.0) {
      now.last = i;
      if (now.size() > best.size()) best = now;
    } else {
      now = {i - 1, i};
    }
  }
  return best;
}

// n random numbers go up and down in turns with a probability of about 4 (2 / pi)^(n + 1) (Andre 1879).
bool are_by_chance(const Turns& turns, std::size_t rows) {
  constexpr double kByChanceAtMost = 0.001;  // of such stretches in one recording, as in lost_forces
  const auto n = static_cast<double>(turns.size());
  return static_cast<double>(rows) * 4.0 * std::pow(2.0 / std::numbers::pi, n + 1.0) > kByChanceAtMost;
}

// Growth of every second sample from the first to the last quarter of the stretch, and its standard
// deviation.
struct HalfGrowth {
  double rise_N = 0.0, error_N = 0.0;
  std::size_t row = 0;  // its first row
};

HalfGrowth growth_of(const ForceAtDepth& pairs, const Turns& turns, std::size_t begin) {
  std::vector<double> half;
  for (std::size_t i = turns.first + begin; i <= turns.last; i += 2) half.push_back(pairs.force_N[i]);
  const std::size_t quarter = half.size() / 4;
  HalfGrowth growth{.row = pairs.rows[turns.first + begin]};
  for (std::size_t i = 0; i < quarter; ++i)
    growth.rise_N += (half[half.size() - 1 - i] - half[i]) / static_cast<double>(quarter);
  growth.error_N = noise_of_bends(half) * std::sqrt(2.0 / static_cast<double>(quarter));
  return growth;
}

// The command that keeps the rows of one half; it needs every line of the stretch.
std::string half_cure(const RecordingPlaces& places, const ForceAtDepth& pairs, const Turns& turns,
                      const HalfGrowth& kept) {
  const auto first = places.line_of(pairs.rows[turns.first]), last = places.line_of(pairs.rows[turns.last]);
  const auto name = std::filesystem::path(places.file).filename().string();
  const auto begin = places.line_of(0);
  if (last - first + 1 != turns.size()) return "write the two readings into columns of their own";
  return fmt::format(
      "write the two readings into columns of their own; to keep the one that grows: awk 'NR < {} || NR % 2 "
      "== {}' {} > one_of_{}",
      begin, places.line_of(kept.row) % 2, name, name);
}

}  // namespace

void check_alternating_rows(TrialRecording& recording, const RecordingPlaces& places) {
  constexpr double kAlikeSides = 0.5, kBeyondNoise = 5.0;  // as in lost_forces and surface_onset
  const ForceAtDepth pairs(recording);
  if (pairs.size() < 2) return;
  const auto turns = longest_turns(pairs.force_N);
  if (are_by_chance(turns, pairs.size())) return;
  auto more = growth_of(pairs, turns, 0), less = growth_of(pairs, turns, 1);
  if (std::abs(more.rise_N) < std::abs(less.rise_N)) std::swap(more, less);
  // An input that is read shows noise; zeros between samples are held_samples.
  if (!(less.error_N > 0.0)) return;
  const bool is_clear = std::abs(more.rise_N) > kBeyondNoise * std::hypot(more.error_N, less.error_N);
  if (!is_clear || std::abs(less.rise_N) > kAlikeSides * std::abs(more.rise_N)) return;
  doubt_column(
      recording, places, places.is_stated("force_N"), "force_N",
      fmt::format("goes up and down in turns in lines {} to {}: every second row grows by {:.3g} N, the rows "
                  "between by {:.2g} N. Two readings stand in one column, as of the two channels of an HX711",
                  places.line_of(pairs.rows[turns.first]), places.line_of(pairs.rows[turns.last]),
                  more.rise_N, less.rise_N),
      half_cure(places, pairs, turns, more));
}

}  // namespace sandhopper
