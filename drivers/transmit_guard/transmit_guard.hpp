#pragma once
#include <linux/can.h>

#include <array>
#include <cstdint>

#include "drivers/transmit_guard/frame_decoder.hpp"
#include "drivers/transmit_guard/guard_limits.hpp"
#include "drivers/transmit_guard/rule.hpp"

namespace sandhopper::transmit {

// Commands that the latched fault still allows. Each level includes the following ones.
enum class Allowance : std::uint8_t {
  motion,    // no fault, or one that ends in a soft stop
  holding,   // stiffness and damping, no feed-forward torque
  damping,   // damping only
  no_torque  // commands without torque and gains, leave
};

// Input of the guard before each cycle's frames.
struct CycleState {
  std::int64_t now_ns = 0;
  Allowance allowance = Allowance::motion;
  bool emergency_stop = true;  // e-stop line as the board reads it
};

// Judges every frame before it is sent. It uses only its CycleState, the frames sent and the frames
// received. Allocates, locks and throws nothing; reads no clock.
//
// A drive counts as confirmed in motor mode when
//   mit: an enter frame was sent,
//   servo, v3 (no enter frame): a command without torque was sent,
// and at least two replies (servo: status frames) arrived afterwards; the first of them may still answer an
// earlier command. A leave frame, an open e-stop or Allowance::no_torque ends the confirmation. In addition
// torque and stiffness need a reply within the last `most_unanswered` frames. A drive answers every command,
// in motor mode or not. So the guard cannot see that an enter frame was lost; the driver has to.
//
// After its first refusal only frames without torque and gains pass, until a restart.
class TransmitGuard {
 public:
  explicit TransmitGuard(const Limits& limits) noexcept;

  // Call it before the frames of a cycle.
  void begin(const CycleState& state) noexcept;
  // The port begins a cycle: one frame per motor may follow.
  void begin_frames() noexcept;
  // Time passes without a cycle (pause).
  void advance(std::int64_t duration_ns) noexcept { now_ns_ += duration_ns; }

  struct Verdict {
    Rule rule = Rule::none;
    std::uint8_t motor = 0;
    bool known = false;  // the identifier belongs to `motor`
    Decoded decoded{};
  };
  Verdict judge(const can_frame& frame) const noexcept;

  // Call sent() if the frame of a verdict was sent, refused() if it was not.
  void sent(const Verdict& verdict, std::int64_t time_ns) noexcept;
  void refused() noexcept { latched_ = true; }
  void received(const can_frame& frame) noexcept;

  std::int64_t now_ns() const noexcept { return now_ns_; }
  bool confirmed(std::size_t motor) const noexcept;
  const can_frame& zero_frame(std::size_t motor) const noexcept { return decoder_[motor].zero_frame(); }

 private:
  // State of one motor as the guard knows it.
  struct Motor {
    MotorLimits limit{};
    double frame_bits = 0.0;  // worst-case bits of a command and its answer on the bus
    // Frames sent.
    bool entered = false;
    bool loaded = false;  // the last command had torque or gains
    bool stiff = false;
    int frames = 0;  // in this cycle
    int unanswered = 0;
    std::int64_t sent_ns = 0;
    // Frames received.
    int replies = 0;  // since the motor was entered
    bool heard = false;
    State state{};
  };

  Rule within_limits(const Motor& motor, const FrameDecoder& decoder, const Decoded& d) const noexcept;
  Rule allowed(const Motor& motor, const FrameDecoder& decoder, const Decoded& d) const noexcept;
  Rule energise(const Motor& motor, const FrameDecoder& decoder, const Decoded& d) const noexcept;
  Rule in_order(const Motor& motor, const Decoded& d) const noexcept;
  bool damps(const Motor& motor, const FrameDecoder& decoder, const Decoded& d) const noexcept;

  std::size_t count_;
  std::array<FrameDecoder, kMotorCount> decoder_;
  std::array<Motor, kMotorCount> motor_;
  double bits_per_ns_;
  double bits_waiting_ = 0.0;  // sent bits that the bus has not yet transmitted at its allowed share
  std::int64_t bits_until_ns_ = 0;
  std::int64_t now_ns_ = 0;
  Allowance allowance_ = Allowance::motion;
  bool emergency_stop_ = true;
  bool latched_ = false;
};

}  // namespace sandhopper::transmit
