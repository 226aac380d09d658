#include "tools/diagnose/plants/rotary_axis/free_axis.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tools/diagnose/plants/inputs.hpp"

namespace sandhopper::diagnose {
namespace {

bool is_silent(const std::vector<double>& torque) {
  return std::ranges::all_of(torque, [](double v) { return v == 0.0 || std::isnan(v); });
}

}  // namespace

std::optional<double> let_go_s(const Trial& trial) {
  // d_1 and d_2 as shares of the whole range; d_1 is at least kNoise standard deviations, d_2 kApart times
  // d_1.
  constexpr double kFirst = 0.01, kSecond = 0.1, kNoise = 6.0, kApart = 2.0;
  const auto angle = samples_of(trial, "position_rad");
  if (angle.value.size() < 20) return std::nullopt;
  const double start = angle.value.front();
  double farthest = 0.0;
  for (const double v : angle.value) farthest = std::max(farthest, std::abs(v - start));
  const double first = std::max(kFirst * farthest, kNoise * fluctuation_rms(angle)),
               second = kSecond * farthest;
  if (second < kApart * first) return std::nullopt;  // noise hides the start of the motion
  const auto moved = [&](double least) {
    const auto there =
        std::ranges::find_if(angle.value, [&](double v) { return std::abs(v - start) > least; });
    return static_cast<std::size_t>(there - angle.value.begin());
  };
  const std::size_t at_first = moved(first);
  const double begun_s = angle.time_s.front(), first_s = angle.time_s[at_first],
               second_s = angle.time_s[moved(second)];
  const double direction = angle.value[at_first] > start ? 1.0 : -1.0;
  double back = 0.0;
  for (std::size_t i = 0; i < at_first; ++i) back = std::max(back, direction * (start - angle.value[i]));
  const double root_0 = std::sqrt(back), root_1 = std::sqrt(first + back), root_2 = std::sqrt(second + back);
  const double per_root_s = (second_s - first_s) / (root_2 - root_1);
  const double held_s = first_s - begun_s - (root_1 + root_0) * per_root_s;
  // A hold counts if it lasts longer than half of the time until the first motion.
  if (held_s < 0.5 * (first_s - begun_s)) return std::nullopt;
  return first_s;
}

FreeAxes take_free_axes(std::vector<Trial>& trials, const std::vector<std::optional<bool>>& motor_on) {
  FreeAxes out;
  const auto is_recorded = [](const Trial& trial) { return trial.channels.contains("torque_Nm"); };
  const bool anywhere = std::ranges::any_of(trials, is_recorded);
  for (std::size_t i = 0; i < trials.size(); ++i) {
    Trial& trial = trials[i];
    if (!is_recorded(trial)) {
      if (motor_on[i].value_or(anywhere)) continue;
      trial.channels["torque_Nm"].assign(trial.time_s.size(), 0.0);
      ++out.without_torque;
      if (!motor_on[i]) ++out.unstated;
    }
    auto& torque = trial.channels["torque_Nm"];
    if (!is_silent(torque)) continue;
    const auto free_s = let_go_s(trial);
    if (!free_s) continue;
    for (std::size_t k = 0; k < torque.size() && trial.time_s[k] < *free_s; ++k)
      torque[k] = std::numeric_limits<double>::quiet_NaN();
    ++out.held;
    out.longest_held_s = std::max(out.longest_held_s, *free_s - trial.time_s.front());
  }
  return out;
}

}  // namespace sandhopper::diagnose
