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
  constexpr double kFirst = 0.01, kSecond = 0.1, kNoise = 6.0, kApart = 2.0;
  const auto angle = samples_of(trial, "position_rad");
  if (angle.value.size() < 20) return std::nullopt;
  const double start = angle.value.front();
  double farthest = 0.0;
  for (const double v : angle.value) farthest = std::max(farthest, std::abs(v - start));
  const double first = std::max(kFirst * farthest, kNoise * fluctuation_rms(angle)),
               second = kSecond * farthest;
  if (second < kApart * first) return std::nullopt;  // noise hides the start of the motion
  const auto moved_s = [&](double least) {
    const auto there =
        std::ranges::find_if(angle.value, [&](double v) { return std::abs(v - start) > least; });
    return angle.time_s[static_cast<std::size_t>(there - angle.value.begin())];
  };
  const double begun_s = angle.time_s.front(), first_s = moved_s(first), second_s = moved_s(second);
  const double held_s = first_s - (second_s - first_s) / (std::sqrt(second / first) - 1.0) - begun_s;
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
