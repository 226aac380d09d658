#include "tools/campaign/sharp_turns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "tools/campaign/implausible.hpp"
#include "tools/campaign/only_jump.hpp"
#include "tools/campaign/signal_noise.hpp"

namespace sandhopper {
namespace {

// Speeds one step before and after the step in which the angle turns.
struct SharpTurn {
  std::size_t sample = 0;  // last one before the turn
  double before_radps = 0.0, after_radps = 0.0;
  double angle_rad = 0.0;  // the farther of the two samples beside the turn

  double slower_side() const { return std::min(std::abs(before_radps), std::abs(after_radps)); }
};

double step_speed(const std::vector<StepSample>& s, std::size_t i) {
  return (s[i].value - s[i - 1].value) / (s[i].t_s - s[i - 1].t_s);
}

// Median of the changes of the speed over the span of a turn.
double usual_change(const std::vector<StepSample>& s) {
  std::vector<double> changes;
  for (std::size_t i = 1; i + 2 < s.size(); ++i)
    changes.push_back(std::abs(step_speed(s, i + 2) - step_speed(s, i)));
  const auto middle = changes.begin() + static_cast<std::ptrdiff_t>(changes.size() / 2);
  std::nth_element(changes.begin(), middle, changes.end());
  return *middle;
}

std::vector<SharpTurn> sharp_turns(const std::vector<StepSample>& s) {
  constexpr double kClear = 5.0;  // in standard deviations of a speed
  std::vector<double> values;
  for (const auto& sample : s) values.push_back(sample.value);
  const double usual_s = (s.back().t_s - s.front().t_s) / static_cast<double>(s.size() - 1);
  const double clear = kClear * std::numbers::sqrt2 * noise_of_bends(values) / usual_s;
  const double usual = usual_change(s);
  std::vector<SharpTurn> turns;
  for (std::size_t i = 1; i + 2 < s.size(); ++i) {
    const double before = step_speed(s, i), after = step_speed(s, i + 2);
    if (before * after >= 0.0 || std::min(std::abs(before), std::abs(after)) < clear) continue;
    if (std::abs(after - before) <= kJumpTimes * usual) continue;
    const double a = s[i].value, b = s[i + 1].value;
    const SharpTurn turn{i, before, after, before > 0.0 ? std::max(a, b) : std::min(a, b)};
    // If the angle turns within the step before or after, the next rows show the same turn better.
    if (turns.empty() || turns.back().sample + 2 < i)
      turns.push_back(turn);
    else if (turn.slower_side() > turns.back().slower_side())
      turns.back() = turn;
  }
  return turns;
}

// The way that the axis goes in one row at a turn: nearer than that the place of the turn is not known.
double row_way(const std::vector<StepSample>& s, const SharpTurn& turn) {
  const double row_s = s[turn.sample + 1].t_s - s[turn.sample].t_s;
  return std::max(std::abs(turn.before_radps), std::abs(turn.after_radps)) * row_s;
}

// The turns within one row's way of +-90 degrees.
std::vector<SharpTurn> at_a_quarter(const std::vector<StepSample>& s, const std::vector<SharpTurn>& turns) {
  std::vector<SharpTurn> out;
  for (const auto& turn : turns)
    if (std::abs(std::abs(turn.angle_rad) - 0.5 * std::numbers::pi) <= row_way(s, turn)) out.push_back(turn);
  return out;
}

bool keep_their_speed(const std::vector<SharpTurn>& turns) {
  constexpr double kSameSpeed = 0.9;  // No stop of an axis gives back more of the speed.
  double before = 0.0, after = 0.0;
  for (const auto& turn : turns) before += std::abs(turn.before_radps), after += std::abs(turn.after_radps);
  return std::min(before, after) > kSameSpeed * std::max(before, after);
}

// The turns at the place of the most frequent one.
std::vector<SharpTurn> at_one_place(const std::vector<StepSample>& s, const std::vector<SharpTurn>& turns) {
  std::vector<SharpTurn> best;
  for (const auto& place : turns) {
    std::vector<SharpTurn> here;
    for (const auto& turn : turns)
      if (std::abs(turn.angle_rad - place.angle_rad) <= std::max(row_way(s, turn), row_way(s, place)))
        here.push_back(turn);
    if (here.size() > best.size()) best = here;
  }
  return best;
}

void doubt_folded(TrialRecording& recording, const RecordingPlaces& places, const std::vector<StepSample>& s,
                  const std::vector<SharpTurn>& turns) {
  const auto& first = turns.front();
  doubt_column(
      recording, places, places.is_stated("position_rad"), "position_rad",
      fmt::format(
          "turns round at +-90 degrees within one row {} times, first in line {}, with {:.3g} rad/s before "
          "and {:.3g} rad/s after: the angle was computed by an arcsine, which folds it there",
          turns.size(), places.line_of(s[first.sample].row), first.before_radps, first.after_radps),
      "compute the angle by atan2 of both axes, or record it with an encoder; only releases below 90 degrees "
      "are right as they are");
}

void note_stop(TrialRecording& recording, const RecordingPlaces& places, const std::vector<StepSample>& s,
               const std::vector<SharpTurn>& turns, std::size_t first_blow) {
  const auto& first = turns.front();
  add_implausible(
      recording, places, FindingSeverity::note, "position_rad",
      fmt::format(
          "turns round near {:.3g} rad within one row {} times, first in line {}, with {:.3g} rad/s before "
          "and {:.3g} rad/s after: the axis hits an end stop, which no torque of this plant describes",
          first.angle_rad, turns.size(), places.line_of(s[first.sample].row), first.before_radps,
          first.after_radps),
      fmt::format(
          "use the rows before the first blow, select = {{ to_line = {} }} in this [[trial]], or remove the "
          "stop",
          places.line_of(s[first_blow].row)));
}

}  // namespace

void check_sharp_turns(TrialRecording& recording, const RecordingPlaces& places) {
  constexpr std::size_t kFewestTurns = 2;  // one may be a blow
  if (!recording.has_time || !recording.has("position_rad") || recording.has("torque_Nm")) return;
  if (any_unusable(recording.findings)) return;
  const auto samples = step_samples(recording, "position_rad");
  if (samples.empty()) return;
  const auto turns = sharp_turns(samples);
  const auto folds = at_a_quarter(samples, turns);
  if (folds.size() >= kFewestTurns && 2 * folds.size() > turns.size() && keep_their_speed(folds))
    return doubt_folded(recording, places, samples, folds);
  const auto stop = at_one_place(samples, turns);
  if (stop.size() >= kFewestTurns) note_stop(recording, places, samples, stop, turns.front().sample);
}

}  // namespace sandhopper
