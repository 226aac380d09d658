#include "drivers/can/cubemars_drives.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "drivers/can/can_socket.hpp"
#include "drivers/can/host_law.hpp"
#include "drivers/clock.hpp"
#include "drivers/device_error.hpp"

namespace sandhopper {

namespace {
constexpr int kProbeTries = 10;
constexpr std::int64_t kProbeWait_ns = 10'000'000;
constexpr std::int64_t kListen_ns = 100'000'000;
constexpr double kRateShare = 0.7;  // least share of status_rate_Hz that a servo drive must send during
                                    // probe()
constexpr std::int64_t kShutDownStep_ns = 1'000'000;
// Motor mode is entered below this speed, because a drive that is entered at speed jumps. The value is well
// above the velocity noise of a drive at rest. A leg at this speed turns 0.5 mrad in a cycle.
constexpr double kStill_radps = 0.5;

constexpr std::size_t index(Side side) { return static_cast<std::size_t>(side); }
}  // namespace

CubeMarsDrives::CubeMarsDrives(const CanConfig& config)
    : CubeMarsDrives(config, std::make_unique<CanSocket>(config.interface, CubeMarsBus(config).filters())) {}

CubeMarsDrives::CubeMarsDrives(const CanConfig& config, std::unique_ptr<CanPort> port)
    : config_(config), bus_(config), port_(std::move(port)), sequence_(config.idle_query_cycles) {
  for (std::size_t i = 0; i < bus_.motor_count(); ++i) sides_.push_back(static_cast<Side>(i));
}

void CubeMarsDrives::probe() {
  // Listen before sending: a drive that sends unasked is in servo mode, whatever it answers later.
  port_->pause(kListen_ns);
  drain([](const MotorReading&) {});
  std::array<std::uint32_t, kMotorCount> unasked{};
  for (const Side side : sides_) unasked[index(side)] = bus_.counters(side).replies;
  const auto all_answered = [&] {
    return std::ranges::all_of(sides_,
                               [&](Side side) { return bus_.counters(side).replies > unasked[index(side)]; });
  };
  for (int i = 0; i < kProbeTries && !all_answered(); ++i) {
    port_->begin_cycle();
    for (const Side side : sides_) send(side, bus_.codec(side).frame(DriveAction::leave, {}, {}));
    port_->pause(kProbeWait_ns);
    drain([](const MotorReading&) {});
  }
  for (const Side side : sides_) require_dialect(side, unasked[index(side)]);
  for (const Side side : sides_) rejected_at_probe_[index(side)] = bus_.counters(side).rejected;
}

void CubeMarsDrives::require_dialect(Side side, std::uint32_t unasked) const {
  const auto& codec = bus_.codec(side);
  const auto& motor = codec.config();
  const auto& seen = bus_.counters(side);
  const std::string dialect(name_of(motor.dialect));
  const std::string device =
      "motor " + motor.name + " (can_id " + std::to_string(motor.can_id) + " on " + config_.interface + ")";
  const std::string mode_cure =
      "Set motor.dialect to what the drive speaks, or switch the drive's mode with CubeMars' serial tool and "
      "power-cycle it";
  if (seen.foreign > 0)
    throw DeviceError(device, "sends frames of another dialect than \"" + dialect + "\"", mode_cure);
  if (seen.rejected > 0)
    throw DeviceError(device, "sends frames of a length that the dialect \"" + dialect + "\" does not have",
                      "Check the drive's board version and mode against motor.dialect");
  if (codec.answers_commands() && unasked > 0)
    throw DeviceError(device,
                      "sends its status unasked, as servo mode does, but its dialect is \"" + dialect + "\"",
                      mode_cure);
  if (!codec.answers_commands() && unasked < kListen_ns * 1e-9 * motor.status_rate_Hz * kRateShare)
    throw DeviceError(
        device,
        "sent " + std::to_string(unasked) + " status frames in " + std::to_string(kListen_ns / 1'000'000) +
            " ms; status_rate_Hz says more",
        "Switch the status on and set its rate with CubeMars' serial tool (some drives come with it "
        "off), or, where there was none, " +
            mode_cure);
  if (seen.replies == 0)
    throw DeviceError(
        device, "no answer within " + std::to_string(kProbeTries * kProbeWait_ns / 1'000'000) + " ms",
        "Check motor power, the CAN cable and its two 120 ohm terminators, the drive's can_id, master_id and "
        "dialect, and that the bus runs at 1 Mbit/s (ip -details link show " +
            config_.interface + ")");
  if (seen.unsolicited > 0)
    throw DeviceError(device, "more than one answer to one command: two drives have this id",
                      "Give each drive its own id, with only one connected at a time");
}

std::optional<std::int64_t> CubeMarsDrives::send(Side side, const std::optional<can_frame>& frame) noexcept {
  if (!frame) return std::nullopt;
  const auto sent_ns = port_->send(*frame);
  if (sent_ns) bus_.command_sent(side, *sent_ns);
  return sent_ns;
}

void CubeMarsDrives::take(const MotorReading& reading) noexcept {
  newest_[index(reading.side)] = reading.sample;
  left_[index(reading.side)].see(reading.sample, bus_.codec(reading.side).config().torque_constant_Nm_per_A);
}

DriveFeedback CubeMarsDrives::feedback() const noexcept {
  DriveFeedback out{.still = true, .left = port_->settled()};
  for (const Side side : sides_) {
    const auto& newest = newest_[index(side)];
    out.still = out.still && newest.time_ns != 0 && std::abs(newest.velocity_radps) < kStill_radps;
    out.left = out.left && left_[index(side)].confirmed();
  }
  return out;
}

bool CubeMarsDrives::may_be_on(Side side) const noexcept {
  return sequence_.energised() && !left_[index(side)].confirmed();
}

// A drive that sent a frame that does not match its dialect gets no torque: its reaction to a command is
// unknown.
bool CubeMarsDrives::right_dialect() const noexcept {
  return std::ranges::all_of(
      sides_, [&](Side side) { return bus_.counters(side).rejected == rejected_at_probe_[index(side)]; });
}

void CubeMarsDrives::command(const std::array<MotorCommand, kMotorCount>& command, DriveRequest request,
                             std::int64_t now_ns) noexcept {
  port_->begin_cycle();
  const bool may_run = port_->counters().state != BusState::off && right_dialect();
  const auto action = sequence_.next(may_run ? request : DriveRequest::off, feedback());
  leaving_cycles_ = sequence_.leaving() ? std::min(leaving_cycles_ + 1, kLeaveOverdue + 1) : 0;
  for (const Side side : sides_) {
    auto& left = left_[index(side)];
    if (!sequence_.leaving()) left.restart();
    // Only one command may be outstanding. Otherwise a late answer to one command would pass for an answer in
    // time to the next. Frames that take torque away are sent regardless.
    const bool waits = bus_.outstanding(side, now_ns);
    if (waits && (action == DriveAction::run || !sequence_.energised())) continue;
    const auto& newest = newest_[index(side)];
    const auto& asked = command[index(side)];
    const auto told = law_in_drive(bus_.codec(side).config())
                          ? asked
                          : host_law(asked, newest, now_ns, config_.motor_torque_Nm);
    const auto sent_ns = send(side, bus_.codec(side).frame(action, told, newest));
    if (sent_ns && action == DriveAction::leave && sequence_.leaving()) left.sent(*sent_ns);
  }
}

BusSample CubeMarsDrives::bus_sample() const noexcept {
  const auto& can = port_->counters();
  BusSample out{.state = can.state,
                .send_failures = can.send_failures,
                .receive_overflows = can.receive_overflows,
                .no_acknowledge = can.no_acknowledge,
                .errors = can.errors};
  for (const Side side : sides_) {
    out.rejected[index(side)] = bus_.counters(side).rejected;
    out.unsolicited[index(side)] = bus_.counters(side).unsolicited;
  }
  return out;
}

bool CubeMarsDrives::shut_down(std::int64_t patience_ns) noexcept {
  for (std::int64_t waited_ns = 0; sequence_.energised(); waited_ns += kShutDownStep_ns) {
    if (waited_ns >= patience_ns || port_->counters().state == BusState::off) return false;
    command({}, DriveRequest::off, monotonic_ns());
    port_->pause(kShutDownStep_ns);
    drain([](const MotorReading&) {});
  }
  return true;
}

}  // namespace sandhopper
