#pragma once
#include <array>
#include <cstdint>
#include <optional>

#include "estimation/leg.hpp"
#include "firmware/controller_config.hpp"
#include "firmware/drive_confirmation.hpp"
#include "firmware/event.hpp"
#include "firmware/robot_estimator.hpp"

namespace sandhopper {

// Check at every start while the robot hangs still. Every drive must be in motor mode (DriveConfirmation).
// Then both encoders must read the angle of the hanging pose and agree, nothing may move, and every sensor
// must deliver. The means of the same window give IMU bias, load-cell tare and body height.
class Arming {
 public:
  Arming(const CycleConfig& config, const Leg& leg) noexcept;

  void begin(std::int64_t now_ns) noexcept;

  struct Verdict {
    bool passed;
    Reason reason;
    std::array<double, 4> values;  // Event::values of zero_check or arming_refused
    StaticCalibration calibration;
  };
  // Empty until the drives are confirmed and window_s has passed, or until they are refused.
  std::optional<Verdict> update(const SensorFrame& frame) noexcept;

  // Writes the drives' command during the check.
  void write(Command& command) const noexcept;

 private:
  struct Mean {
    double sum = 0.0;
    int count = 0;
    void add(double value) noexcept {
      sum += value;
      ++count;
    }
    double value() const noexcept { return count > 0 ? sum / count : 0.0; }
  };
  Verdict judge() const noexcept;
  Verdict not_confirmed() const noexcept;

  const CycleConfig& config_;
  double expected_angle_rad_;
  DriveConfirmation drives_;
  bool confirmed_ = false;
  std::int64_t window_begin_ns_ = 0;
  std::array<Mean, kMotorCount> angle_rad_{};
  std::array<double, kMotorCount> lowest_rad_{}, highest_rad_{};
  Mean body_accel_, foot_accel_, load_cell_, tof_;
};

}  // namespace sandhopper
