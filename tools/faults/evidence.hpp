#pragma once
#include <string>

#include "tools/faults/cell.hpp"

namespace sandhopper::faults {

// Looks for what a fault must show before the cycle can find it: beside another fault it may never get there
// (a drive's error code while no reply arrives). It knows the frames, not the supervisor's rules.
class Evidence {
 public:
  explicit Evidence(const Cell& cell) : fault_(cell.expected), device_(cell.device) {}

  // Once a cycle since the fault was set; `before` is the frame of the cycle before that.
  void see(const SensorFrame& frame, const SensorFrame& before, const StepOutput& output,
           const RobotConfig& robot);
  bool complete() const { return complete_; }
  // So many cycles before the present one it began to show. A current is compared with its torque only when
  // the drives have settled: it shows from then on.
  int cycles_shown() const { return fault_ == Fault::motor_torque_implausible ? 0 : in_a_row_ - 1; }
  // What was looked for, in words.
  std::string wanted() const;

 private:
  bool shows(const SensorFrame& frame, const SensorFrame& before, const StepOutput& output,
             const RobotConfig& robot) const;
  int needed(const RobotConfig& robot) const;  // cycles in a row
  bool any_motor(const SensorFrame& frame, auto&& condition) const;

  Fault fault_;
  Device device_;
  std::uint64_t last_cycle_ = 0;
  double other_began_rad_ = 0.0;  // of a stuck encoder: where the other side stood when it stuck
  int in_a_row_ = 0;
  bool complete_ = false;
};

}  // namespace sandhopper::faults
