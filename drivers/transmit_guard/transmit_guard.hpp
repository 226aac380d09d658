#pragma once
#include <linux/can.h>

#include <array>
#include <cstdint>

#include "drivers/transmit_guard/frame_decoder.hpp"
#include "drivers/transmit_guard/guard_limits.hpp"
#include "drivers/transmit_guard/rule.hpp"

namespace sandhopper::transmit {

// Commands that a latched fault still allows; each level includes the following ones.
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
  bool emergency_stop = true;  // the line as the board reads it
};

// Judges every frame before it is sent, knowing only what it is told (CycleState), the frames that were sent
// and those that arrived. Allocates, locks and throws nothing; reads no clock.
//
// A drive counts as confirmed in motor mode when
//   mit: an enter frame was sent,
//   servo, v3 (no enter frame): a command without torque was sent,
// and at least two replies (servo: status frames) arrived afterwards; the first of them may still belong to
// a command before. A leave frame, an open e-stop or Allowance::no_torque ends it. Torque and stiffness
// further need a reply within the last `most_unanswered` frames. A drive answers every command,
// entered or not, so the guard cannot see that an enter frame was lost: that is the driver's to find out.
//
// After its first refusal only frames without torque and gains pass, until a restart.
class TransmitGuard {
 public:
  explicit TransmitGuard(const Limits& limits) noexcept;

  // Before the frames of a cycle: they may be judged from now on.
  void begin(const CycleState& state) noexcept;
  // The port begins a cycle: one frame a motor.
  void begin_frames() noexcept;
  // Time passes without a cycle.
  void advance(std::int64_t duration_ns) noexcept { now_ns_ += duration_ns; }

  struct Verdict {
    Rule rule = Rule::none;
    std::uint8_t motor = 0;
    bool known = false;  // the identifier is that of `motor`
    Decoded decoded{};
  };
  Verdict judge(const can_frame& frame) const noexcept;

  // The frame of a verdict was sent; or was refused.
  void sent(const Verdict& verdict, std::int64_t time_ns) noexcept;
  void refused() noexcept { latched_ = true; }
  void received(const can_frame& frame) noexcept;

  std::int64_t now_ns() const noexcept { return now_ns_; }
  bool confirmed(std::size_t motor) const noexcept;
  const can_frame& zero_frame(std::size_t motor) const noexcept { return decoder_[motor].zero_frame(); }

 private:
  struct Motor {
    MotorLimits limit{};
    double frame_bits = 0.0;  // on the bus, worst case, with the answer to it
    // What was sent.
    bool entered = false;
    bool loaded = false;  // the last command had torque or gains
    bool stiff = false;
    int frames = 0;  // in this cycle
    int unanswered = 0;
    std::int64_t sent_ns = 0;
    // What arrived.
    int replies = 0;  // since entering
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
  double bits_waiting_ = 0.0;  // of the bus's share, not yet used up by time
  std::int64_t bits_until_ns_ = 0;
  std::int64_t now_ns_ = 0;
  Allowance allowance_ = Allowance::motion;
  bool emergency_stop_ = true;
  bool latched_ = false;
};

}  // namespace sandhopper::transmit
