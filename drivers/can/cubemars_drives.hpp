#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "drivers/can/can_socket.hpp"
#include "drivers/can/cubemars.hpp"
#include "drivers/can/drive_sequence.hpp"

namespace sandhopper {

// Both drives on their bus. One command a cycle and motor, never a second try: a stale torque must not be
// sent. After bus-off only "off" is sent, until a restart.
class CubeMarsDrives {
 public:
  // Throws DeviceError (interface) or std::invalid_argument (configuration). Sends nothing.
  explicit CubeMarsDrives(const CanConfig& config);

  void set_tap(CanTap* tap) noexcept { socket_.set_tap(tap); }

  // Asks each drive for its state with a leave frame, which energises nothing. Throws DeviceError unless each
  // identifier is answered by exactly one drive that speaks the configured dialect.
  void probe();

  // This cycle's frames, left then right.
  void command(const std::array<MotorCommand, kMotorCount>& command, DriveRequest request) noexcept;

  // Everything that has arrived: on_reading(const MotorReading&). Never waits.
  template <class OnReading>
  void drain(OnReading&& on_reading) noexcept {
    socket_.drain([&](const ReceivedFrame& received) {
      if (const auto reading = bus_.receive(received.frame, received.time_ns)) {
        last_position_rad_[static_cast<std::size_t>(reading->side)] = reading->sample.position_rad;
        on_reading(*reading);
      }
    });
  }

  bool wait(std::int64_t timeout_ns) const noexcept { return socket_.wait(timeout_ns); }

  // Zero torque, then out of motor mode; takes some milliseconds. Not for the cycle.
  void shut_down() noexcept;

  const CubeMarsBus& bus() const noexcept { return bus_; }
  const CanSocketCounters& socket_counters() const noexcept { return socket_.counters(); }

 private:
  void send(Side side, const can_frame& frame) noexcept;
  void require_single_answer(Side side) const;

  CanConfig config_;
  CubeMarsBus bus_;
  CanSocket socket_;
  DriveSequence sequence_;
  std::vector<Side> sides_;
  std::array<double, kMotorCount> last_position_rad_{};
};

}  // namespace sandhopper
