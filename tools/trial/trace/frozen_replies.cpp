#include "tools/trial/trace/frozen_replies.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/trial/trace/reply_steps.hpp"

namespace sandhopper::trace {
namespace {

using Replies = std::vector<const TimedReading*>;

struct StandingRun {
  std::size_t first = 0, last = 0;
  double travel_rad = 0.0;  // by the speeds
  double seconds = 0.0;
};

struct StandingRuns {
  std::size_t count = 0;
  std::size_t replies = 0;  // in all of them
  StandingRun first{}, longest{};
};

double speed_at(const Replies& replies, std::size_t i) { return replies[i]->reading.sample.velocity_radps; }

bool is_same_position(const TimedReading& a, const TimedReading& b) {
  return a.reading.sample.position_rad == b.reading.sample.position_rad;
}

bool is_same_reading(const TimedReading& a, const TimedReading& b) {
  return is_same_position(a, b) && a.reading.sample.velocity_radps == b.reading.sample.velocity_radps &&
         a.reading.sample.current_A == b.reading.sample.current_A;
}

StandingRun run_of(const Replies& replies, std::size_t first, std::size_t last, double longest_s) {
  StandingRun run{first, last};
  for (std::size_t i = first + 1; i <= last; ++i) {
    const double dt_s = 1e-9 * static_cast<double>(replies[i]->trace_ns - replies[i - 1]->trace_ns);
    const double counted_s = std::clamp(dt_s, 0.0, longest_s);
    run.travel_rad += 0.5 * (speed_at(replies, i - 1) + speed_at(replies, i)) * counted_s;
    run.seconds += counted_s;
  }
  return run;
}

// Share of the noise in the squares of the speeds.
double noise_share(const Replies& replies, const StandingRun& run) {
  double squares = 0.0;
  for (std::size_t i = run.first; i <= run.last; ++i) squares += std::pow(speed_at(replies, i), 2);
  const double rows = static_cast<double>(run.last - run.first + 1);
  return squares > 0.0 ? speed_noise(replies, run.first, run.last) * rows / squares : 1.0;
}

// `is_same` splits the replies into runs; `is_odd` is asked for each.
template <class Same, class Odd>
StandingRuns find_runs(const Replies& replies, Same&& is_same, Odd&& is_odd) {
  StandingRuns out;
  const double longest_s = static_cast<double>(kLongestStep) * mean_period_s(replies);
  for (std::size_t first = 0; first < replies.size();) {
    std::size_t last = first;
    while (last + 1 < replies.size() && is_same(*replies[last], *replies[last + 1])) ++last;
    if (const auto run = run_of(replies, first, last, longest_s); last > first && is_odd(run)) {
      if (out.count++ == 0) out.first = run;
      if (run.seconds > out.longest.seconds) out.longest = run;
      out.replies += last - first + 1;
    }
    first = last + 1;
  }
  return out;
}

std::string text_of(const Replies& replies, const StandingRuns& runs, const std::string& name,
                    std::string_view same) {
  const auto length = [](const StandingRun& run) { return run.last - run.first + 1; };
  const auto& most = runs.longest;
  std::string text = fmt::format("motor {}: {} replies in a row from line {} on (", name, length(most),
                                 replies[most.first]->line);
  text +=
      fmt::format("{:.3g} s) have {}, although the speed in them is {:.3g} rad/s: it would move {:.3g} rad",
                  most.seconds, same, most.travel_rad / most.seconds, most.travel_rad);
  if (runs.count > 1)
    text += fmt::format("; {} such runs, {} of {} replies, the first from line {} on", runs.count,
                        runs.replies, replies.size(), replies[runs.first.first]->line);
  return text;
}

}  // namespace

bool has_no_speed(const std::vector<TimedReading>& decoded, Side side, const CubeMarsConfig& motor) {
  const auto replies = replies_of(decoded, side);
  if (replies.empty() || fastest_radps(replies) > velocity_step_radps(motor) / std::abs(motor.gear_ratio))
    return false;
  double low = INFINITY, high = -INFINITY;
  for (std::size_t i = 0; i < replies.size(); ++i) {
    if (speed_at(replies, i) != speed_at(replies, 0)) return false;
    low = std::min(low, replies[i]->reading.sample.position_rad);
    high = std::max(high, replies[i]->reading.sample.position_rad);
  }
  return high - low > kTravelSteps * position_step_rad(motor) / std::abs(motor.gear_ratio);
}

Findings frozen_findings(const TraceReport& report, const CanConfig& config) {
  constexpr double kNoise = 0.1;  // as for the ratio of speed and position
  Findings out;
  for (std::size_t m = 0; m < static_cast<std::size_t>(config.motor_count); ++m) {
    const auto& motor = config.motor[m];
    const auto replies = replies_of(report.decoded, static_cast<Side>(m));
    const double least_rad = kTravelSteps * position_step_rad(motor) / std::abs(motor.gear_ratio);
    const double late_rad =
        static_cast<double>(kLongestStep) * mean_period_s(replies) * fastest_radps(replies);
    const auto moves = [&](const StandingRun& run, double more_than_rad) {
      const double travel_rad = std::abs(run.travel_rad);
      return travel_rad > more_than_rad && travel_rad > least_speed_radps(motor) * run.seconds;
    };
    if (has_no_speed(report.decoded, static_cast<Side>(m), motor))
      out.push_back({"no_speed",
                     fmt::format("motor {}: the speed is {:.2g} rad/s in all {} replies, although its "
                                 "position moves: the drive does not send its speed",
                                 motor.name, speed_at(replies, 0), replies.size()),
                     "see the drive's firmware; do not use its speed", false});
    const auto frozen =
        find_runs(replies, is_same_reading, [&](const auto& run) { return moves(run, least_rad); });
    if (frozen.count > 0) {
      out.push_back({"frozen_replies",
                     text_of(replies, frozen, motor.name, "the same position, speed and current"),
                     "the drive or the adapter sends old readings again: power-cycle the drive and record "
                     "again, or use only the replies outside these runs",
                     false});
      continue;
    }
    const auto standing = find_runs(replies, is_same_position, [&](const auto& run) {
      return moves(run, least_rad + late_rad) && noise_share(replies, run) <= kNoise;
    });
    if (standing.count > 0)
      out.push_back({"frozen_position", text_of(replies, standing, motor.name, "one position"),
                     "check the drive's encoder, and the coupling between it and the link", false});
  }
  return out;
}

}  // namespace sandhopper::trace
