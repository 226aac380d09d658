#include "drivers/can/drive_sequence.hpp"

namespace sandhopper {

namespace {
constexpr int kZeroes = 3;
}

DriveAction DriveSequence::next(DriveRequest request, const DriveFeedback& feedback) noexcept {
  switch (state_) {
    case State::off:
      return request != DriveRequest::off ? begin(State::switching_on, feedback) : next_of_off();
    case State::switching_on:
      if (request == DriveRequest::off) return begin(State::switching_off, feedback);
      return next_of_switching_on(feedback);
    case State::on:
      if (request == DriveRequest::off) return begin(State::switching_off, feedback);
      return request == DriveRequest::run ? DriveAction::run : DriveAction::zero;
    case State::switching_off:
      return next_of_switching_off(feedback);
  }
  return DriveAction::leave;
}

DriveAction DriveSequence::begin(State state, const DriveFeedback& feedback) noexcept {
  state_ = state;
  step_ = 0;
  return state == State::switching_on ? next_of_switching_on(feedback) : next_of_switching_off(feedback);
}

DriveAction DriveSequence::next_of_off() noexcept {
  return step_++ % idle_query_cycles_ == 0 ? DriveAction::leave : DriveAction::zero;
}

DriveAction DriveSequence::next_of_switching_on(const DriveFeedback& feedback) noexcept {
  if (step_ == kZeroes + 1 && !feedback.still) return DriveAction::zero;
  const int step = step_++;
  if (step < kZeroes) return DriveAction::zero;
  if (step == kZeroes) return DriveAction::leave;
  if (step == kZeroes + 1) return DriveAction::enter;
  state_ = State::on;
  return DriveAction::zero;
}

DriveAction DriveSequence::next_of_switching_off(const DriveFeedback& feedback) noexcept {
  if (step_ < kZeroes) {
    ++step_;
    return DriveAction::zero;
  }
  if (!feedback.left) return DriveAction::leave;
  state_ = State::off;
  step_ = 1;
  return DriveAction::zero;
}

}  // namespace sandhopper
