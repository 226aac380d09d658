#include "drivers/can/cubemars_drives.hpp"

#include <algorithm>
#include <string>

#include "drivers/clock.hpp"
#include "drivers/device_error.hpp"

namespace sandhopper {

namespace {
constexpr int kProbeTries = 10;
constexpr std::int64_t kProbeWait_ns = 10'000'000;
}  // namespace

CubeMarsDrives::CubeMarsDrives(const CanConfig& config)
    : config_(config),
      bus_(config),
      socket_(config.interface, bus_.filters()),
      sequence_(config.idle_query_cycles) {
  for (std::size_t i = 0; i < bus_.motor_count(); ++i) sides_.push_back(static_cast<Side>(i));
}

void CubeMarsDrives::probe() {
  const auto all_answered = [&] {
    return std::ranges::all_of(sides_, [&](Side side) { return bus_.counters(side).replies > 0; });
  };
  for (int i = 0; i < kProbeTries && !all_answered(); ++i) {
    for (const Side side : sides_) send(side, bus_.codec(side).special_frame(kMitLeave));
    sleep_ns(kProbeWait_ns);
    drain([](const MotorReading&) {});
  }
  for (const Side side : sides_) require_single_answer(side);
}

void CubeMarsDrives::require_single_answer(Side side) const {
  const auto& motor = bus_.codec(side).config();
  const auto& seen = bus_.counters(side);
  const std::string device =
      "motor " + motor.name + " (can_id " + std::to_string(motor.can_id) + " on " + config_.interface + ")";
  if (seen.foreign > 0)
    throw DeviceError(device, "sends servo-mode status frames but its dialect is \"mit\"",
                      "Switch the drive to MIT mode with CubeMars' serial tool and power-cycle it");
  if (seen.rejected > 0)
    throw DeviceError(device, "answers with frames that are not MIT replies (6 to 8 bytes)",
                      "Check the drive's board version and mode against can.motor.dialect");
  if (seen.replies == 0)
    throw DeviceError(
        device, "no answer within " + std::to_string(kProbeTries * kProbeWait_ns / 1'000'000) + " ms",
        "Check motor power, the CAN cable and its two 120 ohm terminators, the drive's can_id and "
        "master_id, and that the bus runs at 1 Mbit/s (ip -details link show " +
            config_.interface + ")");
  if (seen.unsolicited > 0)
    throw DeviceError(device, "more than one answer to one command: two drives have this id",
                      "Give each drive its own id, with only one connected at a time");
}

void CubeMarsDrives::send(Side side, const can_frame& frame) noexcept {
  if (const auto sent_ns = socket_.send(frame)) bus_.command_sent(side, *sent_ns);
}

void CubeMarsDrives::command(const std::array<MotorCommand, kMotorCount>& command,
                             DriveRequest request) noexcept {
  const auto action = sequence_.next(socket_.counters().bus_off ? DriveRequest::off : request);
  for (const Side side : sides_) {
    const auto i = static_cast<std::size_t>(side);
    const auto& codec = bus_.codec(side);
    switch (action) {
      case DriveAction::none:
        break;
      case DriveAction::zero:
        send(side, codec.command_frame({.position_rad = last_position_rad_[i]}));
        break;
      case DriveAction::enter:
        send(side, codec.special_frame(kMitEnter));
        break;
      case DriveAction::leave:
        send(side, codec.special_frame(kMitLeave));
        break;
      case DriveAction::run:
        send(side, codec.command_frame(command[i]));
        break;
    }
  }
}

void CubeMarsDrives::shut_down() noexcept {
  while (sequence_.energised()) {
    command({}, DriveRequest::off);
    sleep_ns(1'000'000);
    drain([](const MotorReading&) {});
  }
}

}  // namespace sandhopper
