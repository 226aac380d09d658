#include "tools/trial/trace/speed_ratio.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "terrain/trial_statistics.hpp"
#include "tools/trial/trace/frozen_replies.hpp"
#include "tools/trial/trace/position_jumps.hpp"
#include "tools/trial/trace/reply_steps.hpp"
#include "tools/trial/trace/timing.hpp"

namespace sandhopper::trace {
namespace {

struct Step {
  double moved_rad = 0.0;
  double velocity_radps = 0.0;  // mean of both replies
  double dt_s = 0.0;
};

std::vector<Step> steps_of(const std::vector<const TimedReading*>& replies, const CubeMarsConfig& motor) {
  std::vector<std::int64_t> times_ns;
  for (const auto* reply : replies) times_ns.push_back(reply->trace_ns);
  const std::int64_t usual_ns = median(steps(times_ns));
  const bool clipped = motor.dialect == Dialect::mit;
  const double end_radps = 0.999 * motor.velocity_range_radps / motor.gear_ratio;
  std::vector<Step> out;
  for (std::size_t i = 1; i < replies.size(); ++i) {
    const auto &a = replies[i - 1]->reading.sample, &b = replies[i]->reading.sample;
    const std::int64_t dt_ns = replies[i]->trace_ns - replies[i - 1]->trace_ns;
    if (dt_ns < 0 || dt_ns > kLongestStep * usual_ns) continue;
    if (clipped && std::max(std::abs(a.velocity_radps), std::abs(b.velocity_radps)) > end_radps) continue;
    const Step step{b.position_rad - a.position_rad, 0.5 * (a.velocity_radps + b.velocity_radps),
                    1e-9 * static_cast<double>(dt_ns)};
    const double longest_s = 1e-9 * static_cast<double>(std::max(dt_ns, usual_ns));
    if (clipped && std::abs(step.moved_rad) > kFastest * end_radps * longest_s + position_step_rad(motor))
      continue;
    out.push_back(step);
  }
  return out;
}

double travel_rad(const std::vector<Step>& steps) {
  double at = 0.0, low = 0.0, high = 0.0;
  for (const auto& step : steps) {
    at += step.moved_rad;
    low = std::min(low, at), high = std::max(high, at);
  }
  return high - low;
}

// A speed that the drive does not send, or a position with exchanged bytes, has no ratio.
bool is_named_otherwise(const TraceReport& report, Side side, const CubeMarsConfig& motor) {
  return has_no_speed(report.decoded, side, motor) || has_exchanged_bytes(report.decoded, side, motor);
}

std::string likely_cure(const CubeMarsConfig& motor, double ratio) {
  if (ratio <= 0.0)
    return "compare the signs of position and speed that this drive sends with its manual: its firmware may "
           "differ";
  if (motor.dialect != Dialect::mit)
    return fmt::format(
        "pole_pairs times drive_reduction is {:.4g} in robot.toml, of this motor it is likely {:.3g}: look "
        "both up and write them",
        motor.pole_pairs * motor.drive_reduction, motor.pole_pairs * motor.drive_reduction * ratio);
  return fmt::format(
      "read the range off the drive with CubeMars' tool and write velocity_range_radps = {:.3g} for this "
      "motor in robot.toml; if the drive has {:.4g}, position_range_rad = {:.4g} is wrong instead, likely "
      "{:.3g}",
      motor.velocity_range_radps / ratio, motor.velocity_range_radps, motor.position_range_rad,
      motor.position_range_rad * ratio);
}

}  // namespace

std::optional<SpeedRatio> speed_ratio(const std::vector<TimedReading>& decoded, Side side,
                                      const CubeMarsConfig& motor) {
  const auto replies = replies_of(decoded, side);
  const auto steps = steps_of(replies, motor);
  if (steps.size() < 2 * kParts) return std::nullopt;
  if (travel_rad(steps) < kTravelSteps * position_step_rad(motor) / std::abs(motor.gear_ratio))
    return std::nullopt;
  double squares = 0.0, products = 0.0, seconds = 0.0;
  for (const auto& s : steps) {
    squares += s.velocity_radps * s.velocity_radps * s.dt_s;
    products += s.velocity_radps * s.moved_rad;
    seconds += s.dt_s;
  }
  const double noise_share =
      squares > 0.0 ? speed_noise(replies, 0, replies.size() - 1) * seconds / squares : 1.0;
  if (noise_share > kDifferent || products == 0.0) return std::nullopt;
  SpeedRatio out{squares / products, 0.0};
  // The ten parts are taken as independent; within one, the errors may depend on each other.
  std::array<double, kParts> errors{};
  for (std::size_t i = 0; i < steps.size(); ++i)
    errors[i * kParts / steps.size()] +=
        steps[i].velocity_radps * (steps[i].velocity_radps * steps[i].dt_s - out.value * steps[i].moved_rad);
  double variance = 0.0;
  for (const double error : errors) variance += error * error;
  out.ci95 =
      student_t95(kParts - 1) * std::sqrt(variance) / std::abs(products) + noise_share * std::abs(out.value);
  return out;
}

Findings speed_findings(const TraceReport& report, const CanConfig& config) {
  Findings out;
  for (std::size_t m = 0; m < static_cast<std::size_t>(config.motor_count); ++m) {
    const auto& motor = config.motor[m];
    if (report.motors[m].set_zero > 0 || is_named_otherwise(report, static_cast<Side>(m), motor)) continue;
    const auto ratio = speed_ratio(report.decoded, static_cast<Side>(m), motor);
    if (!ratio || std::abs(ratio->value - 1.0) <= kDifferent + ratio->ci95) continue;
    std::string text =
        fmt::format("motor {}: its velocity is {:.2f} times the change of its position (+- {:.2f})",
                    motor.name, ratio->value, ratio->ci95);
    if (motor.dialect == Dialect::mit && ratio->value > 0.0)
      text += fmt::format(": velocity_range_radps = {:.3g}? robot.toml has {:.4g}",
                          motor.velocity_range_radps / ratio->value, motor.velocity_range_radps);
    out.push_back({"velocity_range", text, likely_cure(motor, ratio->value), false});
  }
  return out;
}

}  // namespace sandhopper::trace
