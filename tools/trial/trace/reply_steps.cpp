#include "tools/trial/trace/reply_steps.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sandhopper::trace {
namespace {

constexpr double kStepsOf12Bits = 4095.0;

}  // namespace

std::vector<const TimedReading*> replies_of(const std::vector<TimedReading>& decoded, Side side) {
  std::vector<const TimedReading*> out;
  for (const auto& reading : decoded)
    if (reading.reading.side == side) out.push_back(&reading);
  return out;
}

double torque_step_Nm(const CubeMarsConfig& motor) { return 2.0 * motor.torque_range_Nm / kStepsOf12Bits; }

double position_step_rad(const CubeMarsConfig& motor) {
  constexpr double kSteps = 65535.0, kServoStep_rad = 0.1 * std::numbers::pi / 180.0;
  return motor.dialect == Dialect::mit ? 2.0 * motor.position_range_rad / kSteps : kServoStep_rad;
}

double velocity_step_radps(const CubeMarsConfig& motor) {
  constexpr double kErpmStep = 10.0, kRadpsPerRpm = std::numbers::pi / 30.0;
  return motor.dialect == Dialect::mit
             ? 2.0 * motor.velocity_range_radps / kStepsOf12Bits
             : kErpmStep * kRadpsPerRpm / (motor.pole_pairs * motor.drive_reduction);
}

double mean_period_s(const std::vector<const TimedReading*>& replies) {
  if (replies.size() < 2) return 0.0;
  const std::int64_t whole_ns = replies.back()->trace_ns - replies.front()->trace_ns;
  if (whole_ns > 0) return 1e-9 * static_cast<double>(whole_ns) / static_cast<double>(replies.size() - 1);
  std::int64_t forward_ns = 0, count = 0;
  for (std::size_t i = 1; i < replies.size(); ++i) {
    const std::int64_t step_ns = replies[i]->trace_ns - replies[i - 1]->trace_ns;
    if (step_ns >= 0) forward_ns += step_ns, ++count;
  }
  return count > 0 ? 1e-9 * static_cast<double>(forward_ns) / static_cast<double>(count) : 0.0;
}

double fastest_radps(const std::vector<const TimedReading*>& replies) {
  double most = 0.0;
  for (const auto* reply : replies) most = std::max(most, std::abs(reply->reading.sample.velocity_radps));
  return most;
}

double least_speed_radps(const CubeMarsConfig& motor) {
  return 0.5 * kTravelSteps * velocity_step_radps(motor) / std::abs(motor.gear_ratio);
}

double speed_noise(const std::vector<const TimedReading*>& replies, std::size_t first, std::size_t last) {
  double squares = 0.0, count = 0.0;
  for (std::size_t i = first + 2; i <= last && i < replies.size(); ++i) {
    const auto v = [&](std::size_t k) { return replies[k]->reading.sample.velocity_radps; };
    squares += std::pow(v(i) - 2.0 * v(i - 1) + v(i - 2), 2);
    count += 1.0;
  }
  return count > 0.0 ? squares / 12.0 / count : 0.0;
}

}  // namespace sandhopper::trace
