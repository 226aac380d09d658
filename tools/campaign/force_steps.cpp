#include "tools/campaign/force_steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "tools/campaign/force_at_depth.hpp"
#include "tools/campaign/implausible.hpp"
#include "tools/campaign/only_jump.hpp"

namespace sandhopper {
namespace {

// The forces before or after a jump, in the order of their distance from it.
struct Side {
  explicit Side(std::vector<double> forces) : force_N(std::move(forces)) {
    for (std::size_t i = 1; i < force_N.size(); ++i)
      step_N = std::max(step_N, std::abs(force_N[i] - force_N[i - 1]));
    const std::size_t count = std::min(force_N.size(), kRowsOfSlope);
    const double middle = 0.5 * (static_cast<double>(count) - 1.0);
    double sum = 0.0, squares = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
      const double away = static_cast<double>(i) - middle;
      sum += away * force_N[i], squares += away * away;
    }
    if (squares > 0.0) slope_N = sum / squares;
  }

  double next_N() const { return force_N.front(); }
  bool is_clear() const { return std::abs(next_N()) > kJumpTimes * step_N; }

  static constexpr std::size_t kRowsOfSlope = 20;  // as kFewestPushed of lost_forces.cpp
  std::vector<double> force_N;
  double step_N = 0.0;   // largest from row to row
  double slope_N = 0.0;  // per row, away from the jump
};

bool is_alike(double slope, double other) {
  constexpr double kAlikeSides = 0.5;  // as in lost_forces.cpp
  return slope * other > 0.0 &&
         std::abs(slope - other) < kAlikeSides * std::max(std::abs(slope), std::abs(other));
}

// The reason for a doubt; empty without one.
std::string reason(const Side& before, const Side& after) {
  const double usual_N = std::max(before.step_N, after.step_N);
  if (before.next_N() > kJumpTimes * usual_N && after.next_N() < -kJumpTimes * usual_N)
    return "the force changes its sign, and a bed only pushes: a counter was full, or the sensor was turned";
  if (before.is_clear() && std::abs(after.next_N()) <= usual_N && is_alike(-before.slope_N, after.slope_N))
    return "the force begins again at 0 and grows as before: the cell was tared under load";
  if (!before.is_clear() || !after.is_clear()) return "";
  for (const double times : {10.0, 100.0, 1000.0, 0.1, 0.01, 0.001}) {
    const double off_N = std::abs(after.next_N() / times - before.next_N());
    if (off_N <= before.step_N + after.step_N / times && is_alike(-before.slope_N, after.slope_N / times))
      return fmt::format("the force goes on at {:g} times its value and slope: the gain or the unit changed",
                         times);
  }
  return "";
}

// The foot goes by a usual step there, so that it neither fell nor was pulled back.
bool goes_on(const ForceAtDepth& pairs, const Jump& jump) {
  double usual_m = 0.0, there_m = 0.0;
  for (std::size_t i = 1; i < pairs.size(); ++i) {
    const bool is_there = i > jump.before && i <= jump.after;
    double& largest_m = is_there ? there_m : usual_m;
    largest_m = std::max(largest_m, std::abs(pairs.z_m[i] - pairs.z_m[i - 1]));
  }
  return there_m <= usual_m;
}

}  // namespace

void check_force_steps(TrialRecording& recording, const RecordingPlaces& places) {
  const ForceAtDepth pairs(recording);
  if (pairs.size() < kFewestJumpRows) return;
  std::vector<StepSample> samples;
  for (std::size_t i = 0; i < pairs.size(); ++i)
    samples.push_back({pairs.t_s[i], pairs.force_N[i], pairs.rows[i]});
  const auto jump = only_jump(samples);
  if (jump.after == 0 || !goes_on(pairs, jump)) return;
  const auto& force = pairs.force_N;
  const auto at = [&](std::size_t i) { return force.begin() + static_cast<std::ptrdiff_t>(i); };
  std::vector<double> backwards(force.begin(), at(jump.before + 1));
  std::ranges::reverse(backwards);
  const auto why = reason(Side(std::move(backwards)), Side({at(jump.after), force.end()}));
  if (why.empty()) return;
  const auto line = places.line_of(samples[jump.after].row);
  doubt_column(
      recording, places, places.is_stated("force_N"), "force_N",
      fmt::format("jumps from {:.4g} to {:.4g} N in line {} while the foot goes on, ten times farther "
                  "than in any other row: {}",
                  force[jump.before], force[jump.after], line, why),
      fmt::format("keep the part that is right: select = {{ to_line = {} }}, or select = {{ from_line "
                  "= {} }}, in its [[trial]]",
                  places.line_of(samples[jump.before].row), line));
}

}  // namespace sandhopper
