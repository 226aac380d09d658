#pragma once
#include <array>

#include "firmware/command.hpp"
#include "firmware/controller_config.hpp"
#include "firmware/fault.hpp"
#include "firmware/sensor_frame.hpp"

namespace sandhopper {

// The commands of a fault's reaction, hold -> damp -> limp, and what each needs. It is checked every cycle;
// without it the next safer reaction is taken.
//   hold: each motor's position at the fault, not older than kHostLawAge_s then, and what damp needs. Once
//   one
//         motor cannot hold, none holds any more: a spring that came back would jerk.
//   damp: the drive's own law, or, where the host works it out (servo dialect), a velocity not older than
//         kHostLawAge_s. Each motor by itself: one without it makes no torque.
//   limp: nothing. When no motor can damp, the drives go off and stay off.
// The gentlest reaction, stop, is a hop's last stance: it needs every input of the estimate, and each of them
// has a fault of its own, with a harsher reaction, when it is old.
class FaultReaction {
 public:
  // `config` must outlive it.
  explicit FaultReaction(const CycleConfig& config) noexcept : config_(config) {}

  // `energised`: the drives made torque when the fault came; else they are switched off at once.
  void begin(const SensorFrame& frame, bool energised) noexcept;

  // `command.motor` must be zero.
  void write(const SensorFrame& frame, Reaction reaction, double time_s, Command& command) noexcept;

 private:
  std::size_t motors() const noexcept { return static_cast<std::size_t>(config_.robot.motor_count); }
  bool fresh(const SensorFrame& frame, std::size_t motor) const noexcept;
  bool can_damp(const SensorFrame& frame, std::size_t motor) const noexcept;

  const CycleConfig& config_;
  bool energised_ = false;
  bool can_hold_ = false;
  std::array<double, kMotorCount> hold_angle_rad_{};
};

}  // namespace sandhopper
