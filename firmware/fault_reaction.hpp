#pragma once
#include <array>

#include "firmware/command.hpp"
#include "firmware/controller_config.hpp"
#include "firmware/fault.hpp"
#include "firmware/sensor_frame.hpp"

namespace sandhopper {

// Commands of a fault's reaction, hold -> damp -> limp. The inputs that a reaction needs are checked every
// cycle. Without them the next safer reaction is taken.
//   hold: needs each motor's position at the fault, then no older than kHostLawAge_s, and the inputs of damp.
//         Once one motor cannot hold, none holds again: a returning spring would jerk.
//   damp: needs the drive's own law, or, if the host computes it (servo dialect), a velocity no older than
//         kHostLawAge_s. This is decided per motor: a motor without it gets no torque.
//   limp: needs nothing. When no motor can damp, the drives go off and stay off.
// The gentlest reaction, stop, is the last stance of a hop. It needs every input of the estimate. Each input
// has its own fault with a harsher reaction if it is too old.
class FaultReaction {
 public:
  // `config` must outlive it.
  explicit FaultReaction(const CycleConfig& config) noexcept : config_(config) {}

  // `energised`: the drives produced torque when the fault came. Otherwise they are switched off at once.
  void begin(const SensorFrame& frame, bool energised) noexcept;

  // Fills `command` for the time `time_s` since the fault. `command.motor` must be zero before.
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
