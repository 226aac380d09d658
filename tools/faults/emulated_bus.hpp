#pragma once
#include <array>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "drivers/can/can_config.hpp"
#include "drivers/can/can_port.hpp"
#include "tools/faults/injection.hpp"
#include "tools/plant/world.hpp"
#include "tools/virtual_bench/drives/emulated_drive.hpp"

namespace sandhopper::faults {

// A torque up to this value counts as zero: two counts of a command's torque field (8.8 mN m each), rounded
// up.
inline constexpr double kNoTorque_Nm = 0.02;

// Emulated CAN bus and drives in the world's time. It replaces the kernel's socket below the robot's motor
// driver. Commands arrive at once, replies 0.22 ms later; error frames are those of linux/can/error.h. All
// faults of the bus and of the drives' frames are made here.
class EmulatedBus : public CanPort {
 public:
  // `drives`: configuration of the emulated drives; it may differ from the driver's. The world must outlive
  // the bus.
  EmulatedBus(World& world, const CanConfig& drives, std::uint64_t seed);

  // Plants a fault in the bus or a drive; std::nullopt repairs it. Held frames leave when the bus recovers.
  void set(Device device, std::optional<Kind> kind);

  // Loses each frame to the drives for which `lost` is true, as a one-shot controller can: send() succeeds,
  // but the frame never reaches the wire.
  void lose(std::function<bool(const can_frame&)> lost) { lost_ = std::move(lost); }
  // The drive's power stage fails: it accepts commands and answers, but makes no torque.
  void ignore_torque(Side side) { motor_[static_cast<std::size_t>(side)].dead = true; }
  // The fault of the bus ends at this time of the world.
  void heal_at(std::int64_t time_ns) { heal_ns_ = time_ns; }
  // Opens the socket for a new session: counters start at 0, frames received earlier are dropped. Frames of
  // the old session that have not left stay in the controller.
  void reopen() noexcept;

  // Lets the drives act and send their own frames, up to the world's present time.
  void advance();

  // The last command that each drive received, in link coordinates.
  const MotorCommand& command(Side side) const { return motor_[static_cast<std::size_t>(side)].command; }
  // True if the last frames put this drive into motor mode.
  bool enabled(Side side) const { return motor_[static_cast<std::size_t>(side)].enabled; }
  void reset_torque() { most_torque_Nm_ = 0.0; }
  double most_torque_Nm() const { return most_torque_Nm_; }
  // Number of commands with torque that reached a drive more than one cycle after they were sent.
  int stale_torques() const { return stale_torques_; }

  void begin_cycle() noexcept override;
  std::optional<std::int64_t> send(const can_frame& frame) noexcept override;
  std::span<const ReceivedFrame> receive(bool& more) noexcept override;
  bool settled() const noexcept override { return queue_.empty(); }
  void pause(std::int64_t duration_ns) noexcept override;
  bool wait(std::int64_t timeout_ns) noexcept override;
  const CanCounters& counters() const noexcept override { return counters_; }
  void set_tap(CanTap* tap) noexcept override { tap_ = tap; }

 private:
  struct Motor {
    std::unique_ptr<bench::EmulatedDrive> drive;
    std::optional<Kind> fault;
    std::int64_t since_ns = 0;
    MotorSample frozen{};
    int asked = 0;  // requests since the fault was planted
    MotorCommand command{};
    bool enabled = false;
    bool dead = false;
  };
  struct Queued {
    can_frame frame;
    std::int64_t sent_ns;
  };

  MotorSample felt(std::size_t i) const;
  // Power of a drive is lost: its last command is cleared.
  void take_power(std::size_t i);
  void deliver(const Queued& queued);
  void ask(std::size_t i, const Queued& queued);
  void answer(std::size_t i, can_frame frame, std::int64_t at_ns);
  void put(const can_frame& frame, std::int64_t at_ns);
  void put_error(canid_t error_class, std::uint8_t controller);
  bool motor_lost(Motor& motor);
  bool without_power(const Motor& motor) const;
  bool nobody_acknowledges() const;
  // True while frames stay in the controller: the bus is blocked, or no node acknowledges.
  bool holds_frames() const;

  World& world_;
  CanConfig config_;
  Random random_;
  std::vector<Motor> motor_;
  std::optional<Kind> fault_;
  std::function<bool(const can_frame&)> lost_;
  std::int64_t heal_ns_ = INT64_MAX;
  std::deque<Queued> queue_;              // accepted, not yet on the wire
  std::size_t left_over_ = 0;             // frames of queue_ from an earlier session
  std::deque<ReceivedFrame> on_the_way_;  // sorted by time
  std::array<ReceivedFrame, 32> batch_{};
  CanCounters counters_{};
  CanTap* tap_ = nullptr;
  bool holding_ = false;
  double most_torque_Nm_ = 0.0;
  int stale_torques_ = 0;
  std::int64_t delivering_sent_ns_ = 0;
};

}  // namespace sandhopper::faults
