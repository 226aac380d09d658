#include "drivers/transmit_guard/transmit_guard.hpp"

#include <algorithm>
#include <cmath>

namespace sandhopper::transmit {
namespace {

// Time after which a reply counts as lost. A command takes 135 to 160 us on the wire (55 + 10 n bits at 1
// Mbit/s, 80 + 10 n with an extended identifier), its reply as long, and the other motor's frame may be sent
// before.
constexpr std::int64_t kReplyTime_ns = 500'000;
// Two cycles of a full bus: frames accumulate this much if one cycle is late and the next is not.
constexpr double kMostWaiting_bits = 2000.0;
constexpr double kTakesAwayFactor = 2.0;  // factor on kMostWaiting_bits for frames that take torque away
constexpr int kMostFrames = 4;            // frames that take torque away, per motor and cycle
constexpr int kRepliesToConfirm = 2;
constexpr double kRounding = 1e-9;

bool takes_away(Meaning meaning) noexcept { return meaning == Meaning::zero || meaning == Meaning::leave; }
bool energises(Meaning meaning) noexcept {
  return meaning == Meaning::damping || meaning == Meaning::law || meaning == Meaning::current;
}

// False for NaN.
bool within(double value, double limit, double count) noexcept {
  return std::abs(value) <= limit * (1.0 + kRounding) + count;
}

// Frame length with the most stuff bits and the intermission (ISO 11898-1).
double standard_bits(int bytes) noexcept { return 55.0 + 10.0 * bytes; }
double extended_bits(int bytes) noexcept { return 80.0 + 10.0 * bytes; }

double bits_of_frame(Dialect dialect) noexcept {
  if (dialect == Dialect::mit) return 2.0 * standard_bits(8);
  return dialect == Dialect::v3 ? 2.0 * extended_bits(8) : extended_bits(4);
}

}  // namespace

TransmitGuard::TransmitGuard(const Limits& limits) noexcept
    : count_(std::min(limits.motor_count, kMotorCount)),
      decoder_{FrameDecoder{limits.motor[0]}, FrameDecoder{limits.motor[1]}},
      bits_per_ns_(1e-3 * limits.bus_share) {
  for (std::size_t i = 0; i < count_; ++i) {
    const auto& limit = limits.motor[i];
    motor_[i].limit = limit;
    motor_[i].frame_bits = bits_of_frame(limit.dialect);
    if (limit.dialect == Dialect::servo) bits_per_ns_ -= 1e-9 * limit.status_rate_Hz * extended_bits(8);
  }
}

void TransmitGuard::begin(const CycleState& state) noexcept {
  now_ns_ = std::max(now_ns_, state.now_ns);
  allowance_ = state.allowance;
  emergency_stop_ = state.emergency_stop;
  if (!emergency_stop_ && allowance_ != Allowance::no_torque) return;
  for (auto& motor : motor_) motor.entered = false;
}

void TransmitGuard::begin_frames() noexcept {
  for (auto& motor : motor_) motor.frames = 0;
}

TransmitGuard::Verdict TransmitGuard::judge(const can_frame& frame) const noexcept {
  Verdict out{.rule = Rule::identifier};
  for (std::size_t i = 0; i < count_ && !out.known; ++i) {
    out.motor = static_cast<std::uint8_t>(i);
    out.known = frame.can_id == decoder_[i].command_id();
  }
  if (!out.known) return out;
  const auto& motor = motor_[out.motor];
  const auto& decoder = decoder_[out.motor];
  out.decoded = decoder.command(frame);
  out.rule = within_limits(motor, decoder, out.decoded);
  if (out.rule == Rule::none) out.rule = allowed(motor, decoder, out.decoded);
  if (out.rule == Rule::none) out.rule = in_order(motor, out.decoded);
  return out;
}

// Checks the frame alone: length and limits.
Rule TransmitGuard::within_limits(const Motor& motor, const FrameDecoder& decoder,
                                  const Decoded& d) const noexcept {
  if (d.meaning == Meaning::no_frame) return Rule::length;
  if (d.meaning == Meaning::set_zero) return Rule::set_zero;
  if (!energises(d.meaning)) return Rule::none;
  const auto& count = decoder.count();
  const auto& limit = motor.limit;
  if (!within(d.kp_Nm_per_rad, limit.kp_Nm_per_rad, count.kp_Nm_per_rad)) return Rule::stiffness;
  if (!within(d.kd_Nm_s_per_rad, limit.kd_Nm_s_per_rad, count.kd_Nm_s_per_rad)) return Rule::damping;
  if (!within(d.velocity_radps, limit.speed_radps, count.velocity_radps)) return Rule::speed;
  // Torque of the drive's law without the terms that depend on the motor's motion.
  const double forward = d.torque_Nm + d.kd_Nm_s_per_rad * d.velocity_radps;
  const double counts = count.torque_Nm + d.kd_Nm_s_per_rad * count.velocity_radps;
  if (!within(d.torque_Nm, limit.torque_Nm, count.torque_Nm) || !within(forward, limit.torque_Nm, counts))
    return Rule::torque;
  if (d.kp_Nm_per_rad == 0.0) return Rule::none;
  const bool inside = d.position_rad >= limit.angle_min_rad - count.position_rad &&
                      d.position_rad <= limit.angle_max_rad + count.position_rad;
  return inside ? Rule::none : Rule::angle;
}

// Checks the frame against the drive's state and against the present restrictions.
Rule TransmitGuard::allowed(const Motor& motor, const FrameDecoder& decoder,
                            const Decoded& d) const noexcept {
  if (takes_away(d.meaning)) return Rule::none;
  if (latched_) return Rule::latched;
  if (emergency_stop_) return Rule::stopped;
  if (d.meaning == Meaning::enter) {
    if (allowance_ != Allowance::motion) return Rule::restricted;
    return motor.loaded ? Rule::enter_loaded : Rule::none;
  }
  return energise(motor, decoder, d);
}

Rule TransmitGuard::energise(const Motor& motor, const FrameDecoder& decoder,
                             const Decoded& d) const noexcept {
  if (allowance_ == Allowance::no_torque) return Rule::restricted;
  if (!motor.entered || motor.replies < kRepliesToConfirm) return Rule::not_confirmed;
  if (d.meaning == Meaning::damping) return Rule::none;  // the drive damps by itself, without a reply
  if (motor.unanswered > motor.limit.most_unanswered) return Rule::unanswered;
  if (d.meaning == Meaning::current)
    return allowance_ != Allowance::damping || damps(motor, decoder, d) ? Rule::none : Rule::damping;
  const auto& count = decoder.count();
  const bool holding =
      within(d.torque_Nm, 0.0, count.torque_Nm) && within(d.velocity_radps, 0.0, count.velocity_radps);
  if (allowance_ == Allowance::damping || (allowance_ == Allowance::holding && !holding))
    return Rule::restricted;
  if (d.kp_Nm_per_rad == 0.0 || motor.stiff) return Rule::none;
  const double away_rad = d.position_rad - motor.state.position_rad;
  const double counts_rad = count.position_rad + decoder.state_count().position_rad;
  const bool near =
      motor.heard && within(d.kp_Nm_per_rad * away_rad, motor.limit.torque_Nm, d.kp_Nm_per_rad * counts_rad);
  return near ? Rule::none : Rule::stiffness_far;
}

// Servo: true if the current opposes the measured motion and does not exceed the damping limit.
bool TransmitGuard::damps(const Motor& motor, const FrameDecoder& decoder, const Decoded& d) const noexcept {
  const double speed = motor.state.velocity_radps;
  const double counts =
      decoder.count().torque_Nm + motor.limit.kd_Nm_s_per_rad * decoder.state_count().velocity_radps;
  if (!within(d.torque_Nm, motor.limit.kd_Nm_s_per_rad * std::abs(speed), counts)) return false;
  return d.torque_Nm * speed <= 0.0 || within(d.torque_Nm, 0.0, counts);
}

// Checks the frame against the other frames of the cycle and the bus load.
Rule TransmitGuard::in_order(const Motor& motor, const Decoded& d) const noexcept {
  const bool away = takes_away(d.meaning);
  if (motor.frames >= (away ? kMostFrames : 1)) return Rule::second_frame;
  const bool waiting = motor.unanswered > 0 && now_ns_ - motor.sent_ns < kReplyTime_ns;
  if (!away && waiting && motor.limit.dialect != Dialect::servo) return Rule::outstanding;
  const double gone = bits_per_ns_ * static_cast<double>(now_ns_ - bits_until_ns_);
  const double waiting_bits = std::max(0.0, bits_waiting_ - gone) + motor.frame_bits;
  return waiting_bits <= kMostWaiting_bits * (away ? kTakesAwayFactor : 1.0) ? Rule::none : Rule::bus_load;
}

void TransmitGuard::sent(const Verdict& verdict, std::int64_t time_ns) noexcept {
  now_ns_ = std::max(now_ns_, time_ns);
  auto& motor = motor_[verdict.motor];
  const auto meaning = verdict.decoded.meaning;
  const double gone = bits_per_ns_ * static_cast<double>(now_ns_ - bits_until_ns_);
  bits_waiting_ = std::max(0.0, bits_waiting_ - gone) + motor.frame_bits;
  bits_until_ns_ = now_ns_;
  ++motor.frames;
  motor.unanswered = std::min(motor.unanswered + 1, 1'000'000);
  motor.sent_ns = now_ns_;
  motor.loaded = energises(meaning);
  motor.stiff = meaning == Meaning::law && verdict.decoded.kp_Nm_per_rad > 0.0;
  if (meaning == Meaning::leave) motor.entered = false;
  const bool confirmable = !emergency_stop_ && allowance_ != Allowance::no_torque;
  const bool begins = motor.limit.dialect == Dialect::mit
                          ? meaning == Meaning::enter
                          : meaning == Meaning::zero && !motor.entered && confirmable;
  if (!begins) return;
  motor.entered = true;
  motor.replies = 0;
}

void TransmitGuard::received(const can_frame& frame) noexcept {
  for (std::size_t i = 0; i < count_; ++i) {
    const auto state = decoder_[i].reply(frame);
    if (!state) continue;
    auto& motor = motor_[i];
    motor.state = *state;
    motor.heard = true;
    motor.unanswered = 0;
    motor.replies = std::min(motor.replies + 1, kRepliesToConfirm);
    return;
  }
}

bool TransmitGuard::confirmed(std::size_t motor) const noexcept {
  return motor_[motor].entered && motor_[motor].replies >= kRepliesToConfirm;
}

}  // namespace sandhopper::transmit
