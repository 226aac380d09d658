#include "tools/trial/trace/position_jumps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/trial/trace/frozen_replies.hpp"
#include "tools/trial/trace/reply_steps.hpp"

namespace sandhopper::trace {
namespace {

using Replies = std::vector<const TimedReading*>;

constexpr std::size_t kOften = 10;  // One step in so many is a jump: another fault than a lost turn.

double limit_radps(const Replies& replies, const CubeMarsConfig& motor) {
  const double reported = fastest_radps(replies);
  const bool is_reported = reported > least_speed_radps(motor) || motor.dialect != Dialect::mit;
  return kFastest * (is_reported ? reported : motor.velocity_range_radps / std::abs(motor.gear_ratio));
}

// An old reading, sent again. Equal replies of a motor at rest are new readings.
bool is_repeated(const TimedReading& reply, const TimedReading& before, const CubeMarsConfig& motor) {
  const auto &a = reply.reading.sample, &b = before.reading.sample;
  return a.position_rad == b.position_rad && a.velocity_radps == b.velocity_radps &&
         a.current_A == b.current_A && std::abs(a.velocity_radps) > least_speed_radps(motor);
}

// Indices of the replies before which `position` jumps.
template <class Position>
std::vector<std::size_t> jumps_of(const Replies& replies, const CubeMarsConfig& motor, Position&& position) {
  const double fastest = limit_radps(replies, motor);
  const double least_s = static_cast<double>(kLongestStep) * mean_period_s(replies);
  const double rounding_rad = kTravelSteps * position_step_rad(motor) / std::abs(motor.gear_ratio);
  std::vector<std::size_t> out;
  std::size_t measured = 0;  // The reply before is as old as the first one equal to it that reports motion.
  for (std::size_t i = 1; i < replies.size(); ++i) {
    if (!is_repeated(*replies[i - 1], *replies[measured], motor)) measured = i - 1;
    const double dt_s = 1e-9 * static_cast<double>(replies[i]->trace_ns - replies[measured]->trace_ns);
    const double moved_rad = std::abs(position(*replies[i]) - position(*replies[i - 1]));
    if (dt_s >= 0.0 && moved_rad > fastest * std::max(dt_s, least_s) + rounding_rad) out.push_back(i);
  }
  return out;
}

double position_of(const TimedReading& reply) { return reply.reading.sample.position_rad; }

bool is_often(const std::vector<std::size_t>& jumps, const Replies& replies) {
  return jumps.size() * kOften > replies.size();
}

Finding jump_finding(const Replies& replies, const std::vector<std::size_t>& jumps,
                     const CubeMarsConfig& motor) {
  const auto size_at = [&](std::size_t i) { return position_of(*replies[i]) - position_of(*replies[i - 1]); };
  const std::size_t at = jumps.front();
  const double size = size_at(at);
  const auto &before = *replies[at - 1], &after = *replies[at];
  const double between = 0.5 * (before.reading.sample.velocity_radps + after.reading.sample.velocity_radps);
  const double dt_s = 1e-9 * static_cast<double>(after.trace_ns - before.trace_ns);
  std::string text = fmt::format(
      "motor {}: its position jumps by {:+.4g} rad within {:.3g} ms before line {}, where its speed of "
      "{:.3g} "
      "rad/s moves it by {:.2g} rad",
      motor.name, size, 1e3 * dt_s, after.line, between, between * dt_s);
  const double turn_rad = 2.0 * std::numbers::pi, left_rad = size - between * dt_s;
  const double turns = std::round(left_rad / turn_rad);
  const double rounding_rad = kTravelSteps * position_step_rad(motor) / std::abs(motor.gear_ratio);
  if (turns != 0.0 && std::abs(left_rad - turns * turn_rad) < rounding_rad)
    text += fmt::format(" ({:+.0f} turn{})", turns, std::abs(turns) > 1.0 ? "s" : "");
  if (jumps.size() > 1) text += fmt::format("; {} such jumps", jumps.size());
  return {
      "position_jump", text,
      is_often(jumps, replies)
          ? "see that only one drive answers under this number, and that its supply and encoder hold"
          : fmt::format("the drive restarted or lost its count: replay the parts before and after line {} "
                        "as traces of their own, and find the zero of each",
                        after.line),
      false};
}

}  // namespace

bool has_exchanged_bytes(const std::vector<TimedReading>& decoded, Side side, const CubeMarsConfig& motor) {
  const auto replies = replies_of(decoded, side);
  if (motor.dialect != Dialect::mit || !is_often(jumps_of(replies, motor, position_of), replies))
    return false;
  const auto exchanged = [&](const TimedReading& reply) {
    const auto code = static_cast<double>(reply.frame.data[1] + 256 * reply.frame.data[2]);
    return code * position_step_rad(motor) / std::abs(motor.gear_ratio);
  };
  return jumps_of(replies, motor, exchanged).empty();
}

Findings position_jump_findings(const TraceReport& report, const CanConfig& config) {
  Findings out;
  for (std::size_t m = 0; m < static_cast<std::size_t>(config.motor_count); ++m) {
    const auto& motor = config.motor[m];
    const auto side = static_cast<Side>(m);
    const auto replies = replies_of(report.decoded, side);
    if (report.motors[m].set_zero > 0 || replies.empty()) continue;
    if (has_exchanged_bytes(report.decoded, side, motor)) {
      out.push_back({"exchanged_bytes",
                     fmt::format("motor {}: bytes 1 and 2 of its replies, the position, are exchanged: only "
                                 "with the low byte first is the motion smooth",
                                 motor.name),
                     "exchange the two bytes of the position, or set the adapter or gateway that wrote them "
                     "to the drive's order (high byte first)",
                     false});
      continue;
    }
    const auto jumps = jumps_of(replies, motor, position_of);
    if (!jumps.empty()) out.push_back(jump_finding(replies, jumps, motor));
  }
  return out;
}

}  // namespace sandhopper::trace
