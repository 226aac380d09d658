#include "tools/trial/trace/torque_ratio.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "drivers/can/mit_protocol.hpp"
#include "terrain/trial_statistics.hpp"
#include "tools/trial/trace/position_jumps.hpp"
#include "tools/trial/trace/reply_steps.hpp"
#include "tools/trial/trace/speed_ratio.hpp"

namespace sandhopper::trace {
namespace {

// Without right position and speed, the torque of the gains is unknown.
bool has_right_state(const TraceReport& report, std::size_t m, const CubeMarsConfig& motor) {
  const auto side = static_cast<Side>(m);
  if (report.motors[m].set_zero > 0 || has_exchanged_bytes(report.decoded, side, motor)) return false;
  const auto speed = speed_ratio(report.decoded, side, motor);
  return !speed || std::abs(speed->value - 1.0) <= kDifferent + speed->ci95;
}

std::vector<TorquePair> pairs_of(const std::vector<Frame>& frames, const Roles& roles, Side side,
                                 const CubeMarsConfig& motor, bool with_gains) {
  const MitRanges ranges = CubeMarsCodec(motor).ranges();
  std::vector<TorquePair> out;
  MitCommand newest;
  bool waits = false;  // for its reply
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const auto& [role, of] = roles.parts[i];
    if (of != side || (role != Role::command && role != Role::reply)) continue;
    if (role == Role::command) {
      const MitPayload& payload = frames[i].data;
      waits = frames[i].length == payload.size() && !is_special(payload);
      if (waits) newest = unpack_mit_command(ranges, payload);
      continue;
    }
    const auto reply = unpack_mit_reply(ranges, motor.reply,
                                        std::span(frames[i].data.data(), std::size_t{frames[i].length}));
    if (!reply || !waits || reply->error_code != 0) continue;
    if (with_gains || (newest.kp_Nm_per_rad == 0.0 && newest.kd_Nm_s_per_rad == 0.0))
      out.push_back({newest.kp_Nm_per_rad * (newest.position_rad - reply->position_rad) +
                         newest.kd_Nm_s_per_rad * (newest.velocity_radps - reply->velocity_radps) +
                         newest.torque_Nm,
                     reply->torque_Nm});
    waits = false;
  }
  return out;
}

bool is_different(const TorqueRatio& ratio) {
  return ratio.high < 1.0 - kDifferent || ratio.low > 1.0 + kDifferent;
}

// The half with the smaller torques: a drive that limits its torque answers these in full.
std::vector<TorquePair> smaller_half(std::vector<TorquePair> pairs) {
  std::vector<double> sizes;
  for (const auto& pair : pairs) sizes.push_back(std::abs(pair.asked_Nm));
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::ranges::nth_element(sizes, middle);
  std::erase_if(pairs, [&](const TorquePair& pair) { return std::abs(pair.asked_Nm) > *middle; });
  return pairs;
}

}  // namespace

std::optional<TorqueRatio> torque_ratio(const std::vector<TorquePair>& pairs, const CubeMarsConfig& motor) {
  if (pairs.size() < 2 * kParts) return std::nullopt;
  const double count = static_cast<double>(pairs.size());
  TorquePair mean;
  for (const auto& p : pairs) mean.asked_Nm += p.asked_Nm / count, mean.reported_Nm += p.reported_Nm / count;
  double asked = 0.0, both = 0.0, reported = 0.0;
  for (const auto& p : pairs) {
    const double x = p.asked_Nm - mean.asked_Nm, y = p.reported_Nm - mean.reported_Nm;
    asked += x * x, both += x * y, reported += y * y;
  }
  const double least = count * std::pow(torque_step_Nm(motor), 2);  // variation of one step
  if (asked < kTravelSteps * kTravelSteps * least || reported < least || both <= 0.0) return std::nullopt;
  const double slope = both / asked;
  std::array<double, kParts> errors{};
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const double x = pairs[i].asked_Nm - mean.asked_Nm, y = pairs[i].reported_Nm - mean.reported_Nm;
    errors[i * kParts / pairs.size()] += x * (y - slope * x);
  }
  double variance = 0.0;
  for (const double error : errors) variance += error * error;
  const double share = student_t95(kParts - 1) * std::sqrt(variance) / both;
  return TorqueRatio{std::sqrt(reported / asked), slope * (1.0 - share), reported / both * (1.0 + share)};
}

Findings torque_findings(const TraceReport& report, const std::vector<Frame>& frames, const Roles& roles,
                         const CanConfig& config) {
  Findings out;
  for (std::size_t m = 0; m < static_cast<std::size_t>(config.motor_count); ++m) {
    const auto& motor = config.motor[m];
    if (motor.dialect != Dialect::mit) continue;
    const auto pairs =
        pairs_of(frames, roles, static_cast<Side>(m), motor, has_right_state(report, m, motor));
    const auto ratio = torque_ratio(pairs, motor);
    if (!ratio || !is_different(*ratio)) continue;
    const auto small = torque_ratio(smaller_half(pairs), motor);
    if (!small || !is_different(*small)) continue;
    out.push_back(
        {"torque_range",
         fmt::format("motor {}: the torque of its replies is {:.3g} times that of its commands ({:.3g} to "
                     "{:.3g}), by {} of them",
                     motor.name, ratio->value, ratio->low, ratio->high, pairs.size()),
         fmt::format(
             "the drive's commands and replies may have different full scales, or other gain ranges than "
             "kp_range_Nm_per_rad and kd_range_Nm_s_per_rad: likely its replies span {:.3g} Nm, robot.toml "
             "has torque_range_Nm = {:.4g}; compare motor type and ranges with its manual (hop config motor)",
             motor.torque_range_Nm / ratio->value, motor.torque_range_Nm),
         false});
  }
  return out;
}

}  // namespace sandhopper::trace
