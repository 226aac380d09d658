#include "tools/campaign/lost_forces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "tools/campaign/force_at_depth.hpp"
#include "tools/campaign/force_threshold.hpp"
#include "tools/campaign/trial_rows.hpp"

namespace sandhopper {
namespace {

constexpr std::string_view kForce = "force_N";
constexpr std::size_t kFewestPushed = 20;  // rows from which a usual change and a chance can be told
// As the detectors of hop diagnose (data_dropouts, data_stuck): a jump in usual changes, the neighbours that
// give these, the greatest difference of the samples on both sides as a share of the jump, and the number of
// such stretches by chance in one recording.
constexpr double kFar = 8.0, kAlikeSides = 0.5, kGoesOn = 3.0, kByChanceAtMost = 0.001;
constexpr std::size_t kBeside = 6;

// Rows with a force.
struct Forces {
  explicit Forces(const TrialRecording& recording) {
    ForceAtDepth pairs(recording);
    threshold = force_threshold(pairs);
    rows = std::move(pairs.rows), force = std::move(pairs.force_N), height = std::move(pairs.z_m);
  }

  std::size_t size() const { return force.size(); }

  std::size_t end_of_run(std::size_t first) const {
    std::size_t last = first;
    while (last + 1 < size() && force[last + 1] == force[first]) ++last;
    return last;
  }

  // Probability that a sample repeats the one before by chance: the share of repeats outside the stretch,
  // with one more in doubt (rule of succession).
  double repeats_beyond(std::size_t first, std::size_t last) const {
    double equal = 1.0, pairs = 2.0;
    for (std::size_t i = 1; i < size(); ++i) {
      if (i >= first && i <= last + 1) continue;
      // Zeros belong to the same fault.
      if (force[first] == 0.0 && force[i] == 0.0) continue;
      equal += force[i] == force[i - 1], ++pairs;
    }
    return equal / pairs;
  }

  bool is_beyond_chance(std::size_t first, std::size_t last) const {
    const auto repeats = static_cast<double>(last - first);
    return static_cast<double>(size()) * std::pow(repeats_beyond(first, last), repeats) < kByChanceAtMost;
  }

  // Root mean square of the changes on both sides of a stretch, without its edges and without zeros that the
  // same fault wrote.
  double change_beside(std::size_t first, std::size_t last) const {
    double sum = 0.0, count = 0.0;
    const auto add = [&](std::size_t i) {
      if (force[first] == 0.0 && (force[i] == 0.0 || force[i - 1] == 0.0)) return;
      sum += (force[i] - force[i - 1]) * (force[i] - force[i - 1]), ++count;
    };
    for (std::size_t i = first > kBeside ? first - kBeside : 1; i < first; ++i) add(i);
    for (std::size_t i = last + 2; i < std::min(size(), last + 2 + kBeside); ++i) add(i);
    return count > 0.0 ? std::sqrt(sum / count) : std::numeric_limits<double>::infinity();
  }

  // A value written below a threshold, in a row below depth 0.
  bool is_below_threshold(std::size_t i) const {
    return threshold && force[i] == threshold->held_N && height[i] < 0.0;
  }

  std::optional<ForceThreshold> threshold;
  std::vector<std::size_t> rows;
  std::vector<double> force, height;
};

bool falls_to_zero(const Forces& f, std::size_t first, std::size_t last) {
  const double before = f.force[first - 1], after = f.force[last + 1];
  if (f.force[first] != 0.0 || before * after <= 0.0) return false;
  const double least = std::min(std::abs(before), std::abs(after));
  if (!(least > kFar * f.change_beside(first, last))) return false;
  return std::abs(before - after) < kAlikeSides * least || f.is_beyond_chance(first, last);
}

// True if the logger writes zeros again and again: then a zero beside a small force is one of them, too.
bool fills_with_zeros(const Forces& f) {
  constexpr std::size_t kEnough = 3;  // as in data_dropouts
  std::size_t zeros = 0, proven = 0;
  for (std::size_t first = 1; first < f.size();) {
    const std::size_t last = f.end_of_run(first);
    if (f.force[first] == 0.0 && last + 1 < f.size()) ++zeros, proven += falls_to_zero(f, first, last);
    first = last + 1;
  }
  return proven >= kEnough && 2 * proven >= zeros;
}

// A dwell of the foot, and a limit of the cell, hold a value in truth.
bool stands_still(const Forces& f, std::size_t first, std::size_t last, double low, double high) {
  const double value = f.force[first];
  if (last == first || value == 0.0 || value == low || value == high) return false;
  if (!f.is_beyond_chance(first, last)) return false;
  double step = 0.0;
  for (std::size_t i = first + 1; i <= last; ++i)
    step = std::max(step, std::abs(f.height[i] - f.height[i - 1]));
  const bool moves = std::abs(f.height[last] - f.height[first]) > kGoesOn * step && step > 0.0;
  return moves && std::abs(f.force[last + 1] - value) > kGoesOn * f.change_beside(first, last);
}

void note_lost(TrialRecording& recording, const RecordingPlaces& places, const std::vector<LostForce>& lost,
               bool is_zero) {
  std::size_t stretches = 0, rows = 0, first = 0;
  for (const auto& stretch : lost) {
    if (stretch.is_zero != is_zero) continue;
    if (stretches++ == 0) first = stretch.first_row;
    rows += stretch.last_row - stretch.first_row + 1;
  }
  if (stretches == 0) return;
  const std::string place =
      fmt::format("{} in {} rows, first in line {}",
                  stretches == 1 ? "once" : fmt::format("{} times", stretches), rows, places.line_of(first));
  note_at_row(
      recording, places, FindingKind::held_samples, first,
      is_zero ? fmt::format("force_N falls from a force to 0 and comes back, {}: a bed does not let go "
                            "of a foot like that, so there was no sample; hop terrain leaves these rows out",
                            place)
              : fmt::format("force_N stands still while the foot moves on, and then jumps, {}: the "
                            "logger repeated a sample; hop terrain leaves these rows out",
                            place),
      "leave the cell empty where there is no sample");
}

void note_threshold(TrialRecording& recording, const RecordingPlaces& places, const ForceThreshold& found) {
  note_at_row(
      recording, places, FindingKind::held_samples, found.last_row,
      fmt::format(
          "force_N is {:g} in {} rows, down to a depth of {:.3g} mm, and no force lies between that and "
          "{:.3g} N: the recorder writes {:g} below a threshold; hop terrain leaves these rows out, so "
          "that nothing is known of smaller forces",
          found.held_N, found.rows, 1e3 * found.depth_m, found.least_N, found.held_N),
      "set the recorder's threshold to 0 and record again, if the upper layer counts");
}

}  // namespace

std::vector<LostForce> lost_forces(const TrialRecording& recording) {
  std::vector<LostForce> lost;
  const Forces f(recording);
  if (f.size() < kFewestPushed) return lost;
  const auto [low, high] = std::ranges::minmax(f.force);
  const bool zeros_are_lost = fills_with_zeros(f);
  for (std::size_t first = 0; first < f.size();) {
    const std::size_t last = f.end_of_run(first);
    if (f.is_below_threshold(last)) {
      while (!f.is_below_threshold(first)) ++first;
      lost.push_back({f.rows[first], f.rows[last], true});
    } else if (first > 0 && last + 1 < f.size()) {
      if (falls_to_zero(f, first, last) || (zeros_are_lost && f.force[first] == 0.0))
        lost.push_back({f.rows[first], f.rows[last], true});
      else if (stands_still(f, first, last, low, high))
        lost.push_back({f.rows[first + 1], f.rows[last], false});
    }
    first = last + 1;
  }
  return lost;
}

void check_lost_forces(TrialRecording& recording, const RecordingPlaces& places) {
  const auto lost = lost_forces(recording);
  if (const auto threshold = force_threshold(ForceAtDepth(recording)))
    note_threshold(recording, places, *threshold);
  else
    note_lost(recording, places, lost, true);
  note_lost(recording, places, lost, false);
}

void leave_out_lost_forces(TrialRecording& recording) {
  const auto lost = lost_forces(recording);
  const auto force = std::ranges::find(recording.channels, kForce, &TrialRecording::Channel::name);
  if (force == recording.channels.end()) return;
  for (const auto& stretch : lost)
    for (std::size_t row = stretch.first_row; row <= stretch.last_row; ++row)
      force->values[row] = std::numeric_limits<double>::quiet_NaN();
}

}  // namespace sandhopper
