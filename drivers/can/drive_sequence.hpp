#pragma once
#include <cstdint>

#include "drivers/motor_command.hpp"

namespace sandhopper {

// What is sent to a drive in one cycle; zero: a command without gains and torque.
enum class DriveAction : std::uint8_t { none, zero, enter, leave, run };

// State of both drives together, read from their own frames.
struct DriveFeedback {
  bool still = false;  // slow enough to enter motor mode
  bool left = false;   // motor mode is left: LeaveConfirmation
};

// From what the cycle asks of the drives to one frame a cycle:
//   switching on:  zero x3 (a drive remembers its last command), leave, enter once the drives are still,
//   zero;
//                  then run if asked
//   switching off: zero x3, then leave every cycle until the drives confirm it; then zero, which asks for the
//                  state, with leave every `idle_query_cycles`
// Enter is sent once: sent to a moving motor it makes the drive jump. Whether it arrived shows when the motor
// is commanded a torque; who finds that it did not asks for off and on again.
class DriveSequence {
 public:
  explicit DriveSequence(int idle_query_cycles) noexcept : idle_query_cycles_(idle_query_cycles) {}

  DriveAction next(DriveRequest request, const DriveFeedback& feedback) noexcept;

  // Motor mode may be on.
  bool energised() const noexcept { return state_ != State::off; }
  // Leave has been sent and is not confirmed yet, or is to be sent.
  bool leaving() const noexcept { return state_ == State::switching_off; }

 private:
  enum class State : std::uint8_t { off, switching_on, on, switching_off };
  DriveAction begin(State state, const DriveFeedback& feedback) noexcept;
  DriveAction next_of_off() noexcept;
  DriveAction next_of_switching_on(const DriveFeedback& feedback) noexcept;
  DriveAction next_of_switching_off(const DriveFeedback& feedback) noexcept;

  int idle_query_cycles_;
  State state_ = State::off;
  int step_ = 0;
};

}  // namespace sandhopper
