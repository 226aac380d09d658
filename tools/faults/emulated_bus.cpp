#include "tools/faults/emulated_bus.hpp"

#include <linux/can/error.h>

#include <algorithm>
#include <cmath>

namespace sandhopper::faults {
namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kExtraDelay_ns = 1'500'000;
constexpr std::int64_t kErrorDelay_ns = 300'000;  // until a controller without acknowledgement has become
                                                  // error-passive
constexpr double kDrift_radps = 8.0;
constexpr std::int64_t kAnnounced_ns = 3 * kMs;  // from the first under-voltage report to the loss of power
constexpr std::uint8_t kUnderVoltage = 4;        // error code of the drive

std::uint8_t random_byte(Random& random) { return static_cast<std::uint8_t>(256.0 * random.uniform()); }

}  // namespace

EmulatedBus::EmulatedBus(World& world, const CanConfig& drives, std::uint64_t seed)
    : world_(world), config_(drives), random_(seed, 2), motor_(static_cast<std::size_t>(drives.motor_count)) {
  for (std::size_t i = 0; i < motor_.size(); ++i)
    motor_[i].drive = bench::make_drive(
        drives.motor[i], {.sample = [this, i] { return felt(i); },
                          .command =
                              [this, i](const MotorCommand& command, bool enabled) {
                                auto& m = motor_[i];
                                m.command = command;
                                m.enabled = enabled;
                                const double torque = enabled ? std::abs(command.torque_Nm) : 0.0;
                                most_torque_Nm_ = std::max(most_torque_Nm_, torque);
                                const bool stale = world_.now_ns() - delivering_sent_ns_ > kMs;
                                stale_torques_ += stale && torque > kNoTorque_Nm;
                                world_.command(static_cast<Side>(i), command, enabled && !m.dead);
                              }});
}

void EmulatedBus::set(Device device, std::optional<Kind> kind) {
  if (device == Device::bus) {
    fault_ = kind;
    if (kind == Kind::bus_off) put_error(CAN_ERR_BUSOFF, 0);
    if (kind == Kind::passive) put_error(CAN_ERR_CRTL, CAN_ERR_CRTL_TX_PASSIVE);
    if (kind == Kind::no_acknowledge) put_error(CAN_ERR_ACK, 0);
    if (kind == Kind::overflow) put_error(CAN_ERR_CRTL, CAN_ERR_CRTL_RX_OVERFLOW);
    if (kind == Kind::protocol_error) put_error(CAN_ERR_PROT, 0);
    if (holds_frames()) return;
    if (kind == Kind::bus_off) queue_.clear();  // a controller in bus-off sends nothing
    for (const auto& queued : queue_) deliver(queued);
    queue_.clear();
    left_over_ = 0;
    return;
  }
  const auto i = device == Device::motor_left ? std::size_t{0} : std::size_t{1};
  auto& m = motor_[i];
  m.fault.reset();
  m.frozen = felt(i);
  m.fault = kind;
  m.since_ns = world_.now_ns();
  m.asked = 0;
  if (kind == Kind::off) take_power(i);
}

void EmulatedBus::take_power(std::size_t i) {
  motor_[i].command = {};
  motor_[i].enabled = false;
  world_.command(static_cast<Side>(i), {}, false);
}

void EmulatedBus::reopen() noexcept {
  counters_ = {};
  on_the_way_.clear();
  left_over_ = queue_.size();
  holding_ = false;
}

bool EmulatedBus::without_power(const Motor& m) const {
  return m.fault == Kind::off ||
         (m.fault == Kind::announced_loss && world_.now_ns() - m.since_ns >= kAnnounced_ns);
}

// A frame needs one node that acknowledges it. There is none if the cable is off or no drive has power.
bool EmulatedBus::nobody_acknowledges() const {
  return fault_ == Kind::cable_off ||
         std::ranges::all_of(motor_, [this](const Motor& m) { return without_power(m); });
}

bool EmulatedBus::holds_frames() const { return fault_ == Kind::blocked || nobody_acknowledges(); }

// Sensor readings that the drive's firmware gets, with the drive's fault applied.
MotorSample EmulatedBus::felt(std::size_t i) const {
  auto s = world_.read_motor(static_cast<Side>(i));
  const auto& m = motor_[i];
  if (!m.fault) return s;
  switch (*m.fault) {
    case Kind::stuck:
      s.position_rad = m.frozen.position_rad;
      s.velocity_radps = 0.0;
      break;
    case Kind::wrong:
      s.velocity_radps *= 2.0;
      break;
    case Kind::saturated:
      s.velocity_radps = config_.motor[i].velocity_range_radps;
      break;
    case Kind::drifting:
      s.position_rad += kDrift_radps * 1e-9 * static_cast<double>(world_.now_ns() - m.since_ns);
      break;
    case Kind::error:
      s.error_code = 5;
      break;
    case Kind::announced_loss:
      s.error_code = kUnderVoltage;
      break;
    case Kind::hot:
      s.temperature_C = 120.0;
      break;
    case Kind::current:
      s.current_A += 10.0;
      break;
    case Kind::overcurrent:
      s.current_A = 60.0;
      break;
    case Kind::undervoltage:
      s.bus_voltage_V = 10.0;
      break;
    default:
      break;
  }
  return s;
}

void EmulatedBus::begin_cycle() noexcept {
  holding_ = queue_.size() > left_over_;
  if (holding_) ++counters_.send_failures;
}

std::optional<std::int64_t> EmulatedBus::send(const can_frame& frame) noexcept {
  if (holding_) return std::nullopt;
  if (fault_ == Kind::refused || fault_ == Kind::bus_off || counters_.state == BusState::off) {
    ++counters_.send_failures;
    return std::nullopt;
  }
  const auto now_ns = world_.now_ns();
  ++counters_.sent;
  if (tap_ != nullptr) tap_->on_frame(frame, now_ns, true);
  const Queued queued{frame, now_ns};
  if (holds_frames()) {
    if (nobody_acknowledges() && queue_.size() == left_over_) {
      can_frame error{};
      error.can_id = CAN_ERR_FLAG | CAN_ERR_CRTL | CAN_ERR_ACK;
      error.can_dlc = CAN_ERR_DLC;
      error.data[1] = CAN_ERR_CRTL_TX_PASSIVE;
      put(error, now_ns + kErrorDelay_ns);
    }
    queue_.push_back(queued);
    return now_ns;
  }
  if (!lost_ || !lost_(frame)) deliver(queued);
  return now_ns;
}

void EmulatedBus::deliver(const Queued& queued) {
  delivering_sent_ns_ = queued.sent_ns;
  for (std::size_t i = 0; i < motor_.size(); ++i) ask(i, queued);
  delivering_sent_ns_ = world_.now_ns();
}

void EmulatedBus::ask(std::size_t i, const Queued& queued) {
  auto& m = motor_[i];
  if (without_power(m)) return;
  const auto now_ns = world_.now_ns();
  const auto reply = m.drive->receive(queued.frame, now_ns);
  if (!reply || motor_lost(m)) return;
  const bool late = m.fault == Kind::delayed || fault_ == Kind::late;
  answer(i, *reply, now_ns + bench::EmulatedDrive::kReplyDelay_ns + (late ? kExtraDelay_ns : 0));
}

bool EmulatedBus::motor_lost(Motor& m) {
  if (fault_ == Kind::lost) return true;
  if (m.fault == Kind::slow) return ++m.asked % 3 != 0;
  if (m.fault == Kind::intermittent) return ++m.asked % 2 != 0;
  return false;
}

void EmulatedBus::answer(std::size_t i, can_frame frame, std::int64_t at_ns) {
  if (motor_[i].fault == Kind::garbage)
    for (std::size_t b = 1; b < 8; ++b) frame.data[b] = random_byte(random_);
  if (fault_ == Kind::malformed) frame.can_dlc = 4;
  put(frame, at_ns);
  if (fault_ == Kind::duplicated) put(frame, at_ns + 130'000);
}

void EmulatedBus::put(const can_frame& frame, std::int64_t at_ns) {
  const auto later = std::ranges::find_if(on_the_way_, [&](const auto& f) { return f.time_ns > at_ns; });
  on_the_way_.insert(later, {frame, at_ns});
}

void EmulatedBus::put_error(canid_t error_class, std::uint8_t controller) {
  can_frame error{};
  error.can_id = CAN_ERR_FLAG | error_class;
  error.can_dlc = CAN_ERR_DLC;
  error.data[1] = controller;
  put(error, world_.now_ns());
}

void EmulatedBus::advance() {
  const auto now_ns = world_.now_ns();
  if (now_ns >= heal_ns_) {
    heal_ns_ = INT64_MAX;
    set(Device::bus, {});
  }
  delivering_sent_ns_ = now_ns;
  for (std::size_t i = 0; i < motor_.size(); ++i) {
    auto& m = motor_[i];
    if (without_power(m) && m.enabled) take_power(i);
    while (m.drive->next_own_ns() <= now_ns) {
      const auto at_ns = std::max(m.drive->next_own_ns(), now_ns - kMs);
      const auto own = m.drive->act(now_ns);
      if (own && !without_power(m) && !motor_lost(m)) answer(i, *own, at_ns);
    }
  }
  if (fault_ != Kind::foreign) return;
  can_frame foreign{};
  const bool mit = config_.motor[0].dialect == Dialect::mit;
  const auto id = static_cast<canid_t>(config_.motor[0].can_id);
  foreign.can_id = mit ? CAN_EFF_FLAG | 0x2900U | id : id;
  foreign.data[0] = static_cast<std::uint8_t>(id);
  foreign.can_dlc = 8;
  put(foreign, now_ns);
}

std::span<const ReceivedFrame> EmulatedBus::receive(bool& more) noexcept {
  std::size_t count = 0;
  while (count < batch_.size() && !on_the_way_.empty() && on_the_way_.front().time_ns <= world_.now_ns()) {
    const auto received = on_the_way_.front();
    on_the_way_.pop_front();
    if (tap_ != nullptr) tap_->on_frame(received.frame, received.time_ns, false);
    if ((received.frame.can_id & CAN_ERR_FLAG) != 0) {
      count_error_frame(received.frame, counters_);
      continue;
    }
    ++counters_.received;
    batch_[count++] = received;
  }
  more = count == batch_.size();
  return {batch_.data(), count};
}

void EmulatedBus::pause(std::int64_t duration_ns) noexcept {
  const auto until_ns = world_.now_ns() + duration_ns;
  while (world_.now_ns() < until_ns) {
    world_.advance_to(std::min(until_ns, world_.now_ns() + kMs));
    advance();
  }
}

bool EmulatedBus::wait(std::int64_t timeout_ns) noexcept {
  pause(timeout_ns);
  return !on_the_way_.empty() && on_the_way_.front().time_ns <= world_.now_ns();
}

}  // namespace sandhopper::faults
