#pragma once
#include <linux/can.h>

#include <cstdint>
#include <optional>

#include "drivers/transmit_guard/guard_limits.hpp"

namespace sandhopper::transmit {

// Effect of a frame on the drive that receives it.
enum class Meaning : std::uint8_t {
  zero,     // a command without torque and gains: it is answered and energises nothing
  damping,  // only a damping gain: the drive's own law dissipates energy
  law,      // torque, stiffness or velocity set-point
  current,  // servo: a current other than zero
  enter,    // motor mode (mit)
  leave,
  set_zero,  // present position becomes zero (mit): no replies for 0.5 to 1.5 s
  no_frame   // length does not match the drive's dialect (eight bytes; servo: four)
};

// A frame as the drive would interpret it, at the link. enter, leave and set_zero have no law fields.
struct Decoded {
  Meaning meaning = Meaning::no_frame;
  double position_rad = 0.0;
  double velocity_radps = 0.0;
  double kp_Nm_per_rad = 0.0;
  double kd_Nm_s_per_rad = 0.0;
  double torque_Nm = 0.0;
};

// The state in a drive's answer or status frame, at the link.
struct State {
  double position_rad = 0.0;
  double velocity_radps = 0.0;
};

// Frames to and from one drive, decoded from the drives' manuals alone (AK Series Module
// Driver User Manual V1.0.18 and V3.0.1), without the driver's code: x = lo + u (hi - lo) / (2^n - 1).
// A signed field has no code for zero, so the two codes next to the middle count as zero.
class FrameDecoder {
 public:
  explicit FrameDecoder(const MotorLimits& motor) noexcept;

  // Identifier, with its flags, of commands to this drive in its dialect.
  std::uint32_t command_id() const noexcept { return command_id_; }
  Decoded command(const can_frame& frame) const noexcept;

  // Empty for a frame that is not this drive's answer in its dialect.
  std::optional<State> reply(const can_frame& frame) const noexcept;

  // Resolution (one count) of each command field, at the link. It is the tolerance of every limit.
  struct Counts {
    double position_rad, velocity_radps, kp_Nm_per_rad, kd_Nm_s_per_rad, torque_Nm;
  };
  const Counts& count() const noexcept { return count_; }
  // Resolution of a reply's fields.
  const State& state_count() const noexcept { return state_count_; }

  // The command without torque and gains.
  const can_frame& zero_frame() const noexcept { return zero_; }

 private:
  struct Law {
    std::uint32_t position, velocity, kp, kd, torque;  // codes
  };
  Decoded decode_law(const Law& codes) const noexcept;
  Decoded decode_current(const can_frame& frame) const noexcept;
  std::optional<State> mit_reply(const can_frame& frame) const noexcept;
  std::optional<State> status_frame(const can_frame& frame) const noexcept;

  Dialect dialect_;
  std::uint32_t command_id_;
  std::uint32_t can_id_;
  std::uint32_t master_id_;
  double half_range_rad_, half_range_radps_, half_range_Nm_;  // signed, at the link
  double zero_offset_rad_;
  Counts count_{};
  State state_count_{};
  // Scales of the integers in a status frame.
  double rad_per_position_, radps_per_speed_;
  can_frame zero_{};
};

}  // namespace sandhopper::transmit
