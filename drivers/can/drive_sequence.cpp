#include "drivers/can/drive_sequence.hpp"

namespace sandhopper {

namespace {
constexpr int kZeroes = 3;
}

DriveAction DriveSequence::next(DriveRequest request) noexcept {
  switch (state_) {
    case State::off:
      if (request != DriveRequest::off) return begin(State::switching_on);
      return step_++ % idle_query_cycles_ == 0 ? DriveAction::leave : DriveAction::zero;
    case State::switching_on:
      if (request == DriveRequest::off) return begin(State::switching_off);
      return next_of_switching_on();
    case State::on:
      if (request == DriveRequest::off) return begin(State::switching_off);
      return request == DriveRequest::run ? DriveAction::run : DriveAction::zero;
    case State::switching_off:
      return next_of_switching_off();
  }
  return DriveAction::leave;
}

DriveAction DriveSequence::begin(State state) noexcept {
  state_ = state;
  step_ = 0;
  return state == State::switching_on ? next_of_switching_on() : next_of_switching_off();
}

DriveAction DriveSequence::next_of_switching_on() noexcept {
  const int step = step_++;
  if (step < kZeroes) return DriveAction::zero;
  if (step == kZeroes) return DriveAction::leave;
  if (step == kZeroes + 1) return DriveAction::enter;
  state_ = State::on;
  return DriveAction::zero;
}

DriveAction DriveSequence::next_of_switching_off() noexcept {
  const int step = step_++;
  if (step < kZeroes) return DriveAction::zero;
  state_ = State::off;
  step_ = 1;
  return DriveAction::leave;
}

}  // namespace sandhopper
