#include "firmware/supervision/motor_check.hpp"

#include <algorithm>
#include <cmath>

namespace sandhopper {
namespace {

constexpr double kCycle_s = 1e-3;
constexpr double kLate = 3.0;
constexpr double kErrorTime_s = 0.010;  // low-pass of the errors of velocity and current
constexpr int kErrorCycles = 8;
constexpr double kErrorShare = 0.25;  // tolerance as a share of the speed; a scale wrong by a factor of two
                                      // gives 0.5
constexpr double kForget_s = 0.3;     // time constant with which the other side's travel is forgotten
constexpr int kSettle_cycles = 15;    // after the drives come on
constexpr int kSamples = 3;           // current and voltage: as many wrong samples in a row

double followed(double value, double error, double dt_s) noexcept {
  const double share = std::clamp(dt_s / kErrorTime_s, 0.0, 1.0);
  return std::isfinite(error) ? value + share * (error - value) : value;
}

bool pure_torque(const MotorCommand& c) noexcept {
  return c.kp_Nm_per_rad == 0.0 && c.kd_Nm_s_per_rad == 0.0;
}

}  // namespace

void MotorCheck::see(const MotorSample& sample, const Context& context, Findings& findings) noexcept {
  see_replies(sample, context, findings);
  see_torque(sample, context, findings);
  if (sample.fresh) {
    // If the position is impossible the other values of the reply are not used either.
    if (see_motion(sample, context, findings)) see_limits(sample, context, findings);
    last_ = sample;
    answered_ = true;
  }
}

void MotorCheck::see_replies(const MotorSample& sample, const Context& context, Findings& findings) noexcept {
  if (!sample.fresh && !answered_ && context.starting) return;
  const auto& s = config_.supervision;
  const double rate_share = std::min(1.0, config_.motor_reply_rate_Hz[motor_] * kCycle_s);
  misses_ = sample.fresh ? 0 : misses_ + 1;
  findings.add_if(misses_ >= config_.limits.motor_reply_misses, Fault::motor_reply_lost, number(), misses_);
  replies_.see(sample.fresh);
  const double wanted = s.motor_reply_share * rate_share;
  findings.add_if(replies_.share() < wanted, Fault::motor_reply_intermittent, number(), replies_.share());
  if (!sample.fresh) return;
  // A reply has the time of the command it answers, which is one cycle ago if the reply came in time.
  const double age_s =
      to_s(context.time_ns - sample.time_ns) - static_cast<double>(context.cycles - 1) * kCycle_s;
  findings.add_if(late_.see(age_s > s.motor_reply_age_s) >= kLate, Fault::motor_reply_late, number(), age_s);
}

bool MotorCheck::see_motion(const MotorSample& sample, const Context&, Findings& findings) noexcept {
  const double dt_s = to_s(sample.time_ns - last_.time_ns);
  if (!answered_ || dt_s <= 0.0) return true;
  const double moved = sample.position_rad - last_.position_rad;
  const double allowed = config_.limits.motor_speed_radps * dt_s + config_.supervision.motor_jump_rad;
  const bool possible = std::abs(moved) <= allowed;  // false for NaN
  findings.add_if(!possible, Fault::motor_position_jump, number(), moved);
  if (!possible) return false;
  const double mean_radps = 0.5 * (sample.velocity_radps + last_.velocity_radps);
  velocity_error_radps_ = followed(velocity_error_radps_, mean_radps - moved / dt_s, dt_s);
  // Fast reversals, as at an end stop, cause a larger difference between the two than steady rotation.
  const double speed_radps = std::max(std::abs(mean_radps), std::abs(moved / dt_s));
  const bool wrong = std::abs(velocity_error_radps_) >
                     config_.supervision.motor_velocity_error_radps + kErrorShare * speed_radps;
  velocity_wrong_ = wrong ? velocity_wrong_ + 1 : 0;
  findings.add_if(velocity_wrong_ >= kErrorCycles, Fault::motor_velocity_implausible, number(),
                  velocity_error_radps_);
  return true;
}

void MotorCheck::see_torque(const MotorSample& sample, const Context& context, Findings& findings) noexcept {
  const auto& s = config_.supervision;
  const double cycles_s = static_cast<double>(context.cycles) * kCycle_s;
  const bool limited = context.drive == DriveRequest::run &&
                       std::abs(context.command.torque_Nm) >= 0.999 * config_.limits.motor_torque_Nm;
  at_torque_limit_s_ = limited ? at_torque_limit_s_ + cycles_s : 0.0;
  findings.add_if(at_torque_limit_s_ > s.torque_limit_s, Fault::motor_torque_limit, number(),
                  at_torque_limit_s_);
  if (std::isfinite(sample.current_A)) thermal_.step(sample.current_A, cycles_s);
  findings.add_if(thermal_.winding_C() > s.winding_temperature_C, Fault::motor_winding_hot, number(),
                  thermal_.winding_C());

  const bool comparable = context.drive != DriveRequest::run || pure_torque(context.command);
  running_ = comparable ? std::min(running_ + 1, kSettle_cycles) : 0;
  if (!sample.fresh || running_ < kSettle_cycles) return;
  const double expected = context.drive == DriveRequest::run ? context.command.torque_Nm : 0.0;
  const double felt = config_.torque_constant_Nm_per_A[motor_] * sample.current_A;
  torque_error_Nm_ = followed(torque_error_Nm_, felt - expected, cycles_s);
  torque_wrong_ = std::abs(torque_error_Nm_) > s.motor_torque_error_Nm ? torque_wrong_ + 1 : 0;
  findings.add_if(torque_wrong_ >= kErrorCycles, Fault::motor_torque_implausible, number(), torque_error_Nm_);
}

void MotorCheck::see_limits(const MotorSample& m, const Context& context, Findings& findings) noexcept {
  const auto& limits = config_.limits;
  const auto& s = config_.supervision;
  const bool turning = std::abs(m.velocity_radps) <= limits.motor_speed_radps;  // false for NaN
  findings.add_if(!turning, Fault::motor_speed_limit, number(), m.velocity_radps);
  if (!turning) return;
  findings.add_if(m.error_code != 0, Fault::drive_error, number(), m.error_code);
  const bool reachable =
      m.position_rad >= limits.leg_angle_min_rad && m.position_rad <= limits.leg_angle_max_rad;
  findings.add_if(context.energised && !reachable, Fault::leg_angle_limit, number(), m.position_rad);
  findings.add_if(m.temperature_C > limits.motor_temperature_C, Fault::motor_temperature, number(),
                  m.temperature_C);
  over_current_ = std::abs(m.current_A) <= s.motor_current_A ? 0 : over_current_ + 1;
  findings.add_if(over_current_ >= kSamples, Fault::motor_current_limit, number(), m.current_A);
  const bool supply_wrong = m.bus_voltage_V < s.bus_voltage_min_V || m.bus_voltage_V > s.bus_voltage_max_V;
  wrong_voltage_ = supply_wrong ? wrong_voltage_ + 1 : 0;
  findings.add_if(wrong_voltage_ >= kSamples, Fault::bus_voltage_limit, number(), m.bus_voltage_V);
}

void MotorPairCheck::see(const std::array<MotorSample, kMotorCount>& motor, bool energised,
                         Findings& findings) noexcept {
  if (config_.robot.motor_count != 2 || !motor[0].fresh || !motor[1].fresh) return;
  const double mismatch = motor[0].position_rad - motor[1].position_rad;
  findings.add_if(energised && std::abs(mismatch) > config_.limits.encoder_mismatch_rad,
                  Fault::encoders_disagree, mismatch, config_.limits.encoder_mismatch_rad);
  for (std::size_t i = 0; i < kMotorCount; ++i) {
    auto& anchor = anchor_[i];
    const double own = motor[i].position_rad;
    // Integrate the velocity: a position that jumps alone does not prove that the leg moves.
    const double dt_s = started_ ? to_s(motor[1 - i].time_ns - last_ns_[1 - i]) : 0.0;
    // Let the travel decay. Otherwise a drive whose velocity cannot be zero (half a count of the MIT
    // protocol) would seem to move while it stands.
    anchor.other_travel_rad -= anchor.other_travel_rad * std::clamp(dt_s / kForget_s, 0.0, 1.0);
    anchor.other_travel_rad += motor[1 - i].velocity_radps * dt_s;
    if (!started_ || std::abs(own - anchor.own_rad) > kStill_rad) anchor = {own, 0.0};
    const double moved = std::abs(anchor.other_travel_rad);
    findings.add_if(moved > config_.supervision.encoder_stuck_rad, Fault::encoder_stuck,
                    static_cast<double>(i), moved);
  }
  for (std::size_t i = 0; i < kMotorCount; ++i) last_ns_[i] = motor[i].time_ns;
  started_ = true;
}

}  // namespace sandhopper
