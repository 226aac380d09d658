#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "drivers/can/can_port.hpp"
#include "drivers/can/cubemars.hpp"
#include "drivers/can/drive_sequence.hpp"
#include "drivers/can/leave_confirmation.hpp"

namespace sandhopper {

// Both drives on their bus. Sends one command per cycle and motor and never retries, because a stale torque
// must not be sent. After bus-off only "off" is sent, until a restart.
class CubeMarsDrives {
 public:
  // Throws DeviceError (interface) or std::invalid_argument (configuration). Sends nothing.
  explicit CubeMarsDrives(const CanConfig& config);
  // Uses this port instead of the interface in the configuration.
  CubeMarsDrives(const CanConfig& config, std::unique_ptr<CanPort> port);

  void set_tap(CanTap* tap) noexcept { port_->set_tap(tap); }

  // Listens, then asks each drive for its state with a leave frame, which energises nothing. Throws
  // DeviceError unless each identifier is answered by exactly one drive that uses the configured dialect.
  void probe();

  // Sends this cycle's frames, left then right; `now_ns` is the port's time.
  void command(const std::array<MotorCommand, kMotorCount>& command, DriveRequest request,
               std::int64_t now_ns) noexcept;

  // Calls on_reading(const MotorReading&) for everything that has arrived. Never waits.
  template <class OnReading>
  void drain(OnReading&& on_reading) noexcept {
    port_->drain([&](const ReceivedFrame& received) {
      if (const auto reading = bus_.receive(received.frame, received.time_ns)) {
        take(*reading);
        on_reading(*reading);
      }
    });
  }

  bool wait(std::int64_t timeout_ns) noexcept { return port_->wait(timeout_ns); }

  // Sends zero torque, then leave frames, until every drive has confirmed that it left motor mode; takes some
  // milliseconds. Returns false if the bus is off or a drive has not confirmed within `patience_ns`: that
  // drive may still produce its last torque. Call it again to continue. Not for the cycle.
  bool shut_down(std::int64_t patience_ns = kShutDown_ns) noexcept;
  static constexpr std::int64_t kShutDown_ns = 500'000'000;

  // True if the drives have been leaving motor mode for more than kLeaveOverdue cycles without confirmation
  // by all.
  bool leave_overdue() const noexcept { return leaving_cycles_ > kLeaveOverdue; }
  static constexpr int kLeaveOverdue = 50;
  // True if this drive has not confirmed that it left motor mode.
  bool may_be_on(Side side) const noexcept;

  // Bus state and counters for the cycle's SensorFrame.
  BusSample bus_sample() const noexcept;

  const CubeMarsBus& bus() const noexcept { return bus_; }
  const CanCounters& port_counters() const noexcept { return port_->counters(); }

 private:
  std::optional<std::int64_t> send(Side side, const std::optional<can_frame>& frame) noexcept;
  void take(const MotorReading& reading) noexcept;
  DriveFeedback feedback() const noexcept;
  void require_dialect(Side side, std::uint32_t unasked) const;
  bool right_dialect() const noexcept;

  CanConfig config_;
  CubeMarsBus bus_;
  std::unique_ptr<CanPort> port_;
  DriveSequence sequence_;
  std::vector<Side> sides_;
  std::array<MotorSample, kMotorCount> newest_{};
  std::array<LeaveConfirmation, kMotorCount> left_{};
  int leaving_cycles_ = 0;
  std::array<std::uint32_t, kMotorCount> rejected_at_probe_{};
};

}  // namespace sandhopper
