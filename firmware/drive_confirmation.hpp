#pragma once
#include <array>
#include <cmath>
#include <cstdint>

#include "firmware/command.hpp"
#include "firmware/controller_config.hpp"
#include "firmware/sensor_frame.hpp"

namespace sandhopper {

// A drive is in motor mode when its current follows a commanded torque: the measured torque is within half of
// the commanded one [N m].
inline bool torque_follows(double measured_Nm, double commanded_Nm) noexcept {
  return std::abs(measured_Nm - commanded_Nm) <= 0.5 * std::abs(commanded_Nm);
}

// Confirms, while the robot hangs still, that every drive is in motor mode. No dialect reports motor mode in
// its replies, so it is tested by the drive's behaviour:
//   1. arming.enable_s: the drives enter motor mode with zero gains.
//   2. arming.confirm_s: +-arming.confirm_torque_Nm, half of the time with each sign. The two motors act
//      against each other, so that the leg stays where it is. Measured torque = torque constant x half the
//      difference of the mean currents under both signs, which removes a current sensor's offset. The first
//      4 ms after each change are left out: a reply is up to 2 ms old, and the current needs time.
//   3. If a motor's torque does not follow: drives off for kOff_s, so that the driver sends zero and leave
//      frames. Then all steps again, arming.confirm_tries times in total.
// Part of the cycle: reads no clock, allocates and throws nothing.
class DriveConfirmation {
 public:
  // `config` must outlive it.
  explicit DriveConfirmation(const CycleConfig& config) noexcept : config_(config) {}

  void begin(std::int64_t now_ns) noexcept;

  enum class Result : std::uint8_t { pending, confirmed, refused };
  Result update(const SensorFrame& frame) noexcept;

  // Request to the drives for the next cycle.
  DriveRequest drive() const noexcept;
  double torque_Nm(std::size_t motor) const noexcept;

  // Torque measured in the last try [N m], positive if it follows the command. NaN for a motor that does not
  // exist.
  const std::array<double, kMotorCount>& measured_Nm() const noexcept { return measured_Nm_; }
  int tries() const noexcept { return tries_; }

 private:
  enum class Step : std::uint8_t { enable, positive, negative, off };
  void start(Step step, std::int64_t now_ns) noexcept;
  void add(const SensorFrame& frame) noexcept;
  Result judge(std::int64_t now_ns) noexcept;
  std::size_t motors() const noexcept { return static_cast<std::size_t>(config_.robot.motor_count); }

  static constexpr double kOff_s = 0.02;    // the driver needs 7 cycles to leave motor mode and confirm it
  static constexpr double kSkip_s = 0.004;  // after a change of the commanded torque

  struct Sum {
    double current_A = 0.0;
    int count = 0;
    double mean() const noexcept { return count > 0 ? current_A / count : 0.0; }
  };
  const CycleConfig& config_;
  Step step_ = Step::enable;
  std::int64_t since_ns_ = 0;
  int tries_ = 0;
  std::array<Sum, kMotorCount> positive_{}, negative_{};
  std::array<double, kMotorCount> measured_Nm_{};
};

}  // namespace sandhopper
