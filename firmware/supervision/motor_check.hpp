#pragma once
#include <array>
#include <cstdint>

#include "firmware/command.hpp"
#include "firmware/controller_config.hpp"
#include "firmware/sensor_frame.hpp"
#include "firmware/supervision/counts.hpp"
#include "firmware/supervision/findings.hpp"
#include "firmware/supervision/thermal_model.hpp"

namespace sandhopper {

// Checks one motor with its drive: it must answer in time and often enough; position, velocity and current
// must be consistent and within the limits.
class MotorCheck {
 public:
  MotorCheck(const CycleConfig& config, std::size_t motor) noexcept
      : config_(config), motor_(motor), thermal_(config.supervision) {
    if (config.start.temperatures_known)
      thermal_ =
          ThermalModel(config.supervision, config.start.winding_C[motor], config.start.housing_C[motor]);
  }

  struct Context {
    std::int64_t time_ns;
    std::int64_t cycles;  // since the last frame: 1, more after an overrun
    bool starting;        // the daemon is starting: a drive may not have answered yet
    bool energised;
    DriveRequest drive;           // of the last cycle's command
    const MotorCommand& command;  // likewise
  };
  void see(const MotorSample& sample, const Context& context, Findings& findings) noexcept;
  const ThermalModel& thermal() const noexcept { return thermal_; }

 private:
  void see_replies(const MotorSample& sample, const Context& context, Findings& findings) noexcept;
  // Returns false if the position is impossible.
  bool see_motion(const MotorSample& sample, const Context& context, Findings& findings) noexcept;
  void see_torque(const MotorSample& sample, const Context& context, Findings& findings) noexcept;
  void see_limits(const MotorSample& sample, const Context& context, Findings& findings) noexcept;
  double number() const noexcept { return static_cast<double>(motor_); }

  const CycleConfig& config_;
  std::size_t motor_;
  ThermalModel thermal_;
  bool answered_ = false;  // at least once
  int misses_ = 0;
  LeakyCount late_{0.5};
  RecentShare<50> replies_;
  MotorSample last_{};
  double velocity_error_radps_ = 0.0;
  double torque_error_Nm_ = 0.0;
  int velocity_wrong_ = 0;
  int torque_wrong_ = 0;
  int running_ = 0;  // cycles with pure torque commands
  int over_current_ = 0;
  int wrong_voltage_ = 0;
  double at_torque_limit_s_ = 0.0;
};

// Both sides are one mechanism. An encoder that stands still while the other side turns is stuck; angles that
// drift apart mean that a coupling slips. At rest neither can be detected.
class MotorPairCheck {
 public:
  explicit MotorPairCheck(const CycleConfig& config) noexcept : config_(config) {}
  void see(const std::array<MotorSample, kMotorCount>& motor, bool energised, Findings& findings) noexcept;

 private:
  static constexpr double kStill_rad = 0.002;
  struct Anchor {
    double own_rad = 0.0;
    double other_travel_rad = 0.0;  // travel of the other side since own_rad was stored
  };
  const CycleConfig& config_;
  std::array<Anchor, kMotorCount> anchor_{};
  std::array<std::int64_t, kMotorCount> last_ns_{};
  bool started_ = false;
};

}  // namespace sandhopper
