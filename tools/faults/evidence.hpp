#pragma once
#include <string>

#include "tools/faults/cell.hpp"

namespace sandhopper::faults {

// Decides if a fault has shown the sign that the cycle needs to find it. Another fault may keep the sign away
// (example: a drive's error code while no reply arrives). It looks at frames and outputs and does not use the
// supervisor's rules.
class Evidence {
 public:
  explicit Evidence(const Cell& cell) : fault_(cell.expected), device_(cell.device) {}

  // Call it once per cycle after the fault was planted. `before`: the frame of the last cycle before that.
  void see(const SensorFrame& frame, const SensorFrame& before, const StepOutput& output,
           const RobotConfig& robot);
  bool complete() const { return complete_; }
  // Number of cycles since the present series of signs began. It is 0 for motor_torque_implausible, because
  // the supervisor compares current and torque only after the drives have settled.
  int cycles_shown() const { return fault_ == Fault::motor_torque_implausible ? 0 : in_a_row_ - 1; }
  // Reason, in words, why the sign did not appear.
  std::string wanted() const;

 private:
  bool shows(const SensorFrame& frame, const SensorFrame& before, const StepOutput& output,
             const RobotConfig& robot) const;
  int needed(const RobotConfig& robot) const;  // cycles in a row with the sign
  bool any_motor(const SensorFrame& frame, auto&& condition) const;

  Fault fault_;
  Device device_;
  std::uint64_t last_cycle_ = 0;
  double other_began_rad_ = 0.0;  // encoder_stuck: position of the other motor when the fault was planted
  int in_a_row_ = 0;
  bool complete_ = false;
};

}  // namespace sandhopper::faults
