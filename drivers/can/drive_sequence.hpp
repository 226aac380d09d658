#pragma once
#include <cstdint>

#include "drivers/motor_command.hpp"

namespace sandhopper {

// What is sent to a drive in one cycle; zero: a command without gains and torque.
enum class DriveAction : std::uint8_t { none, zero, enter, leave, run };

// From what the cycle asks of the drives to one frame a cycle:
//   switching on:  zero x3 (a drive remembers its last command), leave, enter once, zero; then run if asked
//   switching off: zero x3, leave; then zero, which asks for the state, with leave every `idle_query_cycles`
// Enter is never repeated: sent to a moving motor it makes the drive jump.
class DriveSequence {
 public:
  explicit DriveSequence(int idle_query_cycles) noexcept : idle_query_cycles_(idle_query_cycles) {}

  DriveAction next(DriveRequest request) noexcept;

  // Motor mode may be on.
  bool energised() const noexcept { return state_ != State::off; }

 private:
  enum class State : std::uint8_t { off, switching_on, on, switching_off };
  DriveAction begin(State state) noexcept;
  DriveAction next_of_switching_on() noexcept;
  DriveAction next_of_switching_off() noexcept;

  int idle_query_cycles_;
  State state_ = State::off;
  int step_ = 0;
};

}  // namespace sandhopper
