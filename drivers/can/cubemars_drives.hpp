#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "drivers/can/can_port.hpp"
#include "drivers/can/cubemars.hpp"
#include "drivers/can/drive_sequence.hpp"

namespace sandhopper {

// Both drives on their bus. One command a cycle and motor, never a second try: a stale torque must not be
// sent. After bus-off only "off" is sent, until a restart.
class CubeMarsDrives {
 public:
  // Throws DeviceError (interface) or std::invalid_argument (configuration). Sends nothing.
  explicit CubeMarsDrives(const CanConfig& config);
  // On another port than the interface of the configuration.
  CubeMarsDrives(const CanConfig& config, std::unique_ptr<CanPort> port);

  void set_tap(CanTap* tap) noexcept { port_->set_tap(tap); }

  // Listens, then asks each drive for its state with a leave frame, which energises nothing. Throws
  // DeviceError unless each identifier is answered by exactly one drive that speaks the configured dialect.
  void probe();

  // This cycle's frames, left then right; `now_ns` is the port's time.
  void command(const std::array<MotorCommand, kMotorCount>& command, DriveRequest request,
               std::int64_t now_ns) noexcept;

  // Everything that has arrived: on_reading(const MotorReading&). Never waits.
  template <class OnReading>
  void drain(OnReading&& on_reading) noexcept {
    port_->drain([&](const ReceivedFrame& received) {
      if (const auto reading = bus_.receive(received.frame, received.time_ns)) {
        newest_[static_cast<std::size_t>(reading->side)] = reading->sample;
        on_reading(*reading);
      }
    });
  }

  bool wait(std::int64_t timeout_ns) noexcept { return port_->wait(timeout_ns); }

  // Zero torque, then out of motor mode; takes some milliseconds. Not for the cycle.
  void shut_down() noexcept;

  // For the cycle's frame.
  BusSample bus_sample() const noexcept;

  const CubeMarsBus& bus() const noexcept { return bus_; }
  const CanCounters& port_counters() const noexcept { return port_->counters(); }

 private:
  void send(Side side, const std::optional<can_frame>& frame) noexcept;
  void require_dialect(Side side, std::uint32_t unasked) const;
  bool right_dialect() const noexcept;

  CanConfig config_;
  CubeMarsBus bus_;
  std::unique_ptr<CanPort> port_;
  DriveSequence sequence_;
  std::vector<Side> sides_;
  std::array<MotorSample, kMotorCount> newest_{};
  std::array<std::uint32_t, kMotorCount> rejected_at_probe_{};
};

}  // namespace sandhopper
