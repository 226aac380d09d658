#include "firmware/drive_confirmation.hpp"

namespace sandhopper {
namespace {

// The two motors get opposite torques, so that the leg does not move.
double direction_of(std::size_t motor) noexcept { return motor == 0 ? 1.0 : -1.0; }

}  // namespace

void DriveConfirmation::begin(std::int64_t now_ns) noexcept {
  tries_ = 0;
  start(Step::enable, now_ns);
}

void DriveConfirmation::start(Step step, std::int64_t now_ns) noexcept {
  step_ = step;
  since_ns_ = now_ns;
  if (step != Step::enable) return;
  ++tries_;
  positive_ = negative_ = {};
  measured_Nm_.fill(kNotMeasured);
}

DriveRequest DriveConfirmation::drive() const noexcept {
  if (step_ == Step::off) return DriveRequest::off;
  return step_ == Step::enable ? DriveRequest::enable : DriveRequest::run;
}

double DriveConfirmation::torque_Nm(std::size_t motor) const noexcept {
  const double torque = config_.arming.confirm_torque_Nm * direction_of(motor);
  if (step_ == Step::positive) return torque;
  return step_ == Step::negative ? -torque : 0.0;
}

DriveConfirmation::Result DriveConfirmation::update(const SensorFrame& frame) noexcept {
  const double elapsed_s = to_s(frame.time_ns - since_ns_);
  switch (step_) {
    case Step::enable:
      if (elapsed_s >= config_.arming.enable_s) start(Step::positive, frame.time_ns);
      return Result::pending;
    case Step::positive:
      if (elapsed_s > kSkip_s) add(frame);
      if (elapsed_s >= 0.5 * config_.arming.confirm_s) start(Step::negative, frame.time_ns);
      return Result::pending;
    case Step::negative:
      if (elapsed_s > kSkip_s) add(frame);
      return elapsed_s >= 0.5 * config_.arming.confirm_s ? judge(frame.time_ns) : Result::pending;
    case Step::off:
      if (elapsed_s >= kOff_s) start(Step::enable, frame.time_ns);
      return Result::pending;
  }
  return Result::pending;
}

void DriveConfirmation::add(const SensorFrame& frame) noexcept {
  auto& sums = step_ == Step::positive ? positive_ : negative_;
  for (std::size_t i = 0; i < motors(); ++i) {
    if (!frame.motor[i].fresh) continue;
    sums[i].current_A += frame.motor[i].current_A;
    ++sums[i].count;
  }
}

DriveConfirmation::Result DriveConfirmation::judge(std::int64_t now_ns) noexcept {
  bool all = true;
  for (std::size_t i = 0; i < motors(); ++i) {
    const double half_difference_A = 0.5 * (positive_[i].mean() - negative_[i].mean());
    measured_Nm_[i] = direction_of(i) * config_.torque_constant_Nm_per_A[i] * half_difference_A;
    all = all && torque_follows(measured_Nm_[i], config_.arming.confirm_torque_Nm);
  }
  if (all) return Result::confirmed;
  if (tries_ >= config_.arming.confirm_tries) return Result::refused;
  start(Step::off, now_ns);
  return Result::pending;
}

}  // namespace sandhopper
