#include "tests/transmit_guard/wire_oracle.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace sandhopper::faults {
namespace {

constexpr double kSlack = 1.0 + 1e-6;

double scaled(unsigned code, unsigned most, double low, double high) {
  return low + (high - low) * static_cast<double>(code) / static_cast<double>(most);
}

unsigned byte_of(const can_frame& frame, int i) { return frame.data[i]; }

bool is_special(const can_frame& frame, unsigned last) {
  for (int i = 0; i < 7; ++i)
    if (frame.data[i] != 0xFF) return false;
  return frame.data[7] == last;
}

int signed_of(unsigned high, unsigned low) {
  const int value = static_cast<int>(high * 256 + low);
  return value > 32767 ? value - 65536 : value;
}

}  // namespace

WireOracle::WireOracle(std::unique_ptr<CanPort> port, const RobotConfig& robot, const Truth& truth,
                       WireRecord& record)
    : ForwardingPort(std::move(port)), robot_(robot), truth_(truth), record_(record) {}

double WireOracle::gain_scale(std::size_t i) const {
  const auto& m = robot_.motor[i];
  return m.gear_ratio * m.gear_ratio * m.torque_constant_Nm_per_A / m.drive_torque_constant_Nm_per_A;
}

void WireOracle::begin_cycle() noexcept {
  for (auto& motor : motor_) motor.energising = 0;
  ForwardingPort::begin_cycle();
}

std::optional<std::int64_t> WireOracle::send(const can_frame& frame) noexcept {
  const auto sent = ForwardingPort::send(frame);
  if (!sent) return sent;
  ++record_.frames;
  for (std::size_t i = 0; i < static_cast<std::size_t>(robot_.robot.motor_count); ++i) {
    const auto& m = robot_.motor[i];
    const auto id = static_cast<canid_t>(m.can_id);
    const canid_t expected = m.dialect == Dialect::mit     ? id
                             : m.dialect == Dialect::servo ? id + 0x100U + CAN_EFF_FLAG
                                                           : id + 0x800U + CAN_EFF_FLAG;
    if (frame.can_id != expected) continue;
    see(i, frame);
    return sent;
  }
  record_.note(fmt::format("identifier {:X}", frame.can_id));
  return sent;
}

void WireOracle::see(std::size_t i, const can_frame& frame) {
  const auto& m = robot_.motor[i];
  const bool servo = m.dialect == Dialect::servo;
  if (frame.can_dlc != (servo ? 4 : 8)) return record_.note(fmt::format("length {}", frame.can_dlc));
  if (servo) {
    std::int64_t current_mA = 0;
    for (int b = 0; b < 4; ++b) current_mA = 256 * current_mA + frame.data[b];
    if (current_mA >= 2'147'483'648) current_mA -= 4'294'967'296;
    return see_current(i, 1e-3 * static_cast<double>(current_mA));
  }
  const auto b = [&](int n) { return byte_of(frame, n); };
  Fields f{};
  const double p = m.position_range_rad, v = m.velocity_range_radps, t = m.torque_range_Nm;
  if (m.dialect == Dialect::mit) {
    if (is_special(frame, 0xFE)) return record_.note("set zero");
    if (is_special(frame, 0xFD)) {
      motor_[i].entered = false;
      return;
    }
    if (is_special(frame, 0xFC)) {
      if (truth_.emergency_stop || entry_of(truth_.fault).reaction > Reaction::stop)
        record_.note("enter after a fault");
      motor_[i] = {.entered = true, .velocity_radps = motor_[i].velocity_radps};
      return;
    }
    f = {.position_rad = scaled(b(0) * 256 + b(1), 65535, -p, p),
         .velocity_radps = scaled(b(2) * 16 + b(3) / 16, 4095, -v, v),
         .kp = scaled(b(3) % 16 * 256 + b(4), 4095, 0, m.kp_range_Nm_per_rad),
         .kd = scaled(b(5) * 16 + b(6) / 16, 4095, 0, m.kd_range_Nm_s_per_rad),
         .torque_Nm = scaled(b(6) % 16 * 256 + b(7), 4095, -t, t)};
  } else {
    f = {.position_rad = scaled(b(3) * 256 + b(4), 65535, -p, p),
         .velocity_radps = scaled(b(5) * 16 + b(6) / 16, 4095, -v, v),
         .kp = scaled(b(0) * 16 + b(1) / 16, 4095, 0, m.kp_range_Nm_per_rad),
         .kd = scaled(b(1) % 16 * 256 + b(2), 4095, 0, m.kd_range_Nm_s_per_rad),
         .torque_Nm = scaled(b(6) % 16 * 256 + b(7), 4095, -t, t)};
  }
  see_law(i, f);
}

void WireOracle::see_law(std::size_t i, const Fields& f) {
  const auto& m = robot_.motor[i];
  const auto& limits = robot_.limits;
  const double torque_scale = m.gear_ratio * m.torque_constant_Nm_per_A / m.drive_torque_constant_Nm_per_A;
  const double count_Nm = 2.0 * m.torque_range_Nm / 4095.0;
  const bool torque = std::abs(f.torque_Nm) > 0.51 * count_Nm;
  if (!torque && f.kp == 0.0 && f.kd == 0.0) return;
  const double torque_Nm = std::abs(f.torque_Nm) * torque_scale;
  const double kp = f.kp * gain_scale(i), kd = f.kd * gain_scale(i);
  const auto above = [](double value, double limit, double count) {
    return !(value <= kSlack * (limit + count));
  };
  if (above(torque_Nm, limits.motor_torque_Nm, count_Nm * torque_scale))
    record_.note(fmt::format("torque {} N m", torque_Nm));
  if (above(kp, limits.fault_hold_stiffness_Nm_per_rad, m.kp_range_Nm_per_rad / 4095.0 * gain_scale(i)))
    record_.note(fmt::format("stiffness {} N m/rad", kp));
  if (above(kd, limits.fault_damping_Nm_s_per_rad, m.kd_range_Nm_s_per_rad / 4095.0 * gain_scale(i)))
    record_.note(fmt::format("damping {} N m s/rad", kd));
  const double angle_rad = m.zero_offset_rad + m.sign * f.position_rad / m.gear_ratio;
  const bool inside =
      angle_rad > limits.leg_angle_min_rad - 0.01 && angle_rad < limits.leg_angle_max_rad + 0.01;
  if (kp > 0.0 && !inside) record_.note(fmt::format("set-point {} rad", angle_rad));
  const Reaction reaction = entry_of(truth_.fault).reaction;
  if (reaction == Reaction::damp && std::abs(f.velocity_radps) > 1.01 * m.velocity_range_radps / 4095.0)
    record_.note("a moving set-point while damping");
  record_.most_torque_share = std::max(record_.most_torque_share, torque_Nm / limits.motor_torque_Nm);
  see_energised(i, kp > 0.0, torque);
}

void WireOracle::see_current(std::size_t i, double current_A) {
  if (current_A == 0.0) {
    motor_[i].entered = true;
    return;
  }
  const auto& m = robot_.motor[i];
  const auto& limits = robot_.limits;
  const double scale = m.torque_constant_Nm_per_A * m.gear_ratio;
  const double torque_Nm = m.sign * current_A * scale;
  if (!(std::abs(torque_Nm) <= kSlack * (limits.motor_torque_Nm + 1e-3 * scale)))
    record_.note(fmt::format("torque {} N m", torque_Nm));
  record_.most_torque_share =
      std::max(record_.most_torque_share, std::abs(torque_Nm) / limits.motor_torque_Nm);
  const bool damping = entry_of(truth_.fault).reaction == Reaction::damp;
  const double power_W = torque_Nm * motor_[i].velocity_radps;
  if (damping && power_W > 0.0 &&
      std::abs(torque_Nm) > 0.1 * limits.fault_damping_Nm_s_per_rad + 2e-3 * scale)
    record_.note("drives the leg while damping");
  see_energised(i, false, !damping);
}

void WireOracle::see_energised(std::size_t i, bool stiff, bool torque) {
  auto& motor = motor_[i];
  record_.torque_frames += torque;
  record_.gain_frames += !torque;
  const Reaction reaction = entry_of(truth_.fault).reaction;
  if (truth_.emergency_stop) record_.note("energised while the e-stop is open");
  if (reaction == Reaction::limp) record_.note("energised while limp");
  if (reaction == Reaction::damp && (stiff || torque)) record_.note("torque or stiffness while damping");
  const bool servo = robot_.motor[i].dialect == Dialect::servo;
  if (reaction == Reaction::hold && torque && !servo) record_.note("torque while holding");
  if (robot_.motor[i].dialect == Dialect::mit && !motor.entered) record_.note("energised outside motor mode");
  if (motor.replies < 1) record_.note("energised before any reply");
  if (++motor.energising > 1) record_.note("two commands in one cycle");
}

std::span<const ReceivedFrame> WireOracle::receive(bool& more) noexcept {
  const auto frames = ForwardingPort::receive(more);
  for (const auto& received : frames)
    for (std::size_t i = 0; i < kMotorCount; ++i) {
      const auto& f = received.frame;
      const auto& m = robot_.motor[i];
      const bool mit = m.dialect == Dialect::mit;
      const auto id = static_cast<canid_t>(m.can_id);
      if (mit ? f.data[0] != id || (f.can_id & CAN_EFF_FLAG) != 0 : f.can_id != (id + 0x2900U + CAN_EFF_FLAG))
        continue;
      ++motor_[i].replies;
      if (mit) continue;
      const double erpm = 10.0 * signed_of(f.data[2], f.data[3]);
      motor_[i].velocity_radps =
          m.sign * erpm / 60.0 * 2.0 * std::numbers::pi / m.pole_pairs / m.drive_reduction / m.gear_ratio;
    }
  return frames;
}

}  // namespace sandhopper::faults
