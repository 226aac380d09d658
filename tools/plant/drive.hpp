#pragma once
#include <cstdint>

#include "drivers/samples.hpp"
#include "firmware/command.hpp"
#include "tools/plant/random.hpp"
#include "tools/plant/world_config.hpp"

namespace sandhopper {

// One motor with its drive: the law torque = kp (p_des - p) + kd (v_des - v) + t_ff with its own encoder's
// measurement, the torque limit, the current loop (first-order lag, exact for a held demand) and the drive's
// measurements. The position is rounded to the encoder's counts after noise; the speed is its difference over
// 0.1 ms through a first-order low-pass. The drive controls current, so a torque constant that differs from
// the nominal one changes the torque, not the current.
class Drive {
 public:
  struct Imperfection {
    bool noisy = true;  // noise and encoder counts
    double torque_constant_relative = 0.0;
    double current_offset_A = 0.0;
  };
  struct Noise {
    Random encoder;
    Random current;
  };

  Drive(const WorldConfig& config, const Imperfection& imperfection, const Noise& noise);

  void place(double angle_rad) noexcept;
  void command(const MotorCommand& command, bool enabled) noexcept;

  // Advances the current loop by one step; the torque is then held through the step.
  void step() noexcept;
  double torque_Nm() const noexcept {
    return (1.0 + imperfection_.torque_constant_relative) * nominal_torque_Nm_;
  }

  // Call it at the end of each step with the link's angle.
  void measure(double angle_rad) noexcept;
  MotorSample sample(std::int64_t time_ns) const noexcept;

 private:
  double encoder_reading_rad(double angle_rad) noexcept;

  WorldMotorConfig motor_;
  Imperfection imperfection_;
  double lag_decay_;
  double velocity_gain_;
  double count_rad_;
  double encoder_noise_rad_;
  double current_noise_A_;
  Noise noise_;

  MotorCommand command_{};
  bool enabled_ = false;
  double nominal_torque_Nm_ = 0.0;  // nominal torque constant x current
  double position_rad_ = 0.0;
  double velocity_radps_ = 0.0;
  double current_A_ = 0.0;
};

}  // namespace sandhopper
