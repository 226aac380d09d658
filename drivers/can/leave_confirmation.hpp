#pragma once
#include <cmath>
#include <cstdint>

#include "drivers/samples.hpp"

namespace sandhopper {

// Confirms that a drive has left motor mode, by its frames after the first leave frame. A reply is as
// old as the command it answers, so replies from the time of the first leave frame on answer leave frames:
// the drive has received them. Servo drives answer nothing; there the status is from after the first one.
// Confirmed after kQuiet such samples in a row without torque. No dialect reports the mode itself, so a drive
// that acknowledges a leave frame and ignores it cannot be told from one that left: its torque is zero, too,
// because zero commands go before.
class LeaveConfirmation {
 public:
  static constexpr int kQuiet = 3;
  // A current sensor's offset and noise stay below this; it moves no leg.
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
  std::int64_t first_ns_ = 0;  // when the first leave frame left; 0: none has
  int quiet_ = 0;
};

}  // namespace sandhopper
