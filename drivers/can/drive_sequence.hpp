#pragma once
#include <cstdint>

#include "drivers/motor_command.hpp"

namespace sandhopper {

// Frame that is sent to a drive in one cycle. zero: a command without gains and torque.
enum class DriveAction : std::uint8_t { none, zero, enter, leave, run };

// State of both drives together, read from their own frames.
struct DriveFeedback {
  bool still = false;  // slow enough to enter motor mode
  bool left = false;   // motor mode was left (LeaveConfirmation)
};

// Turns the cycle's request into one frame per cycle:
//   switching on:  zero x3 (a drive remembers its last command), leave, enter once both are still, zero;
//                  then run if requested
//   switching off: zero x3, then leave every cycle until the drives confirm it; then zero, which asks for the
//                  state, with leave every `idle_query_cycles`
// Enter is sent only once, because it makes a moving motor jump. The sequence cannot see whether the drive
// received it. That shows when a torque is commanded (firmware/drive_confirmation.hpp); the caller then
// requests off and on again.
class DriveSequence {
 public:
  explicit DriveSequence(int idle_query_cycles) noexcept : idle_query_cycles_(idle_query_cycles) {}

  DriveAction next(DriveRequest request, const DriveFeedback& feedback) noexcept;

  // True if motor mode may be on.
  bool energised() const noexcept { return state_ != State::off; }
  // True while leave frames are due or not confirmed yet.
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
