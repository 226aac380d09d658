#pragma once
#include <cmath>
#include <cstdint>

#include "drivers/samples.hpp"

namespace sandhopper {

// Confirms from a drive's frames that it has left motor mode. A reply has the time of the command it answers.
// So a reply stamped at or after the first leave frame answers a leave frame: the drive has received one.
// Servo drives answer nothing; there a status frame after the first leave frame counts. kQuiet such samples
// in a row without torque confirm it. No dialect reports motor mode. So a drive that acknowledges a leave
// frame but ignores it cannot be recognised: its torque is zero, too, because zero commands were sent before.
class LeaveConfirmation {
 public:
  static constexpr int kQuiet = 3;
  // Above a current sensor's offset and noise, and too small to move the leg.
  static constexpr double kNoTorque_Nm = 0.2;

  void restart() noexcept { *this = {}; }
  void sent(std::int64_t time_ns) noexcept {
    if (first_ns_ == 0) first_ns_ = time_ns;
  }
  void see(const MotorSample& sample, double torque_constant_Nm_per_A) noexcept {
    if (first_ns_ == 0 || sample.time_ns < first_ns_) return;
    const bool quiet = std::abs(sample.current_A) * torque_constant_Nm_per_A < kNoTorque_Nm;
    quiet_ = quiet ? quiet_ + 1 : 0;
  }
  bool confirmed() const noexcept { return quiet_ >= kQuiet; }

 private:
  std::int64_t first_ns_ = 0;  // time at which the first leave frame left; 0: none has
  int quiet_ = 0;
};

}  // namespace sandhopper
