#include "tests/transmit_guard/random_robot.hpp"

#include <cmath>

namespace sandhopper::faults {
namespace {

bool chance(Random& random, double probability) { return random.uniform() < probability; }

void draw_drive(CubeMarsConfig& motor, const LimitsConfig& limits, Random& random) {
  motor.sign = chance(random, 0.5) ? 1 : -1;
  motor.gear_ratio = chance(random, 0.5) ? 1.0 : log_uniform(random, 0.5, 4.0);
  motor.zero_offset_rad = chance(random, 0.5) ? 0.0 : random.uniform() - 0.5;
  motor.drive_torque_constant_Nm_per_A = motor.torque_constant_Nm_per_A * log_uniform(random, 0.7, 1.4);
  const double believed = motor.torque_constant_Nm_per_A / motor.drive_torque_constant_Nm_per_A;
  const double gain = motor.gear_ratio * motor.gear_ratio * believed;
  // Each full scale exceeds its limit by a factor of up to fifty.
  motor.torque_range_Nm =
      limits.motor_torque_Nm / motor.gear_ratio / believed * log_uniform(random, 1.01, 50.0);
  motor.kp_range_Nm_per_rad =
      std::max(1.0, limits.fault_hold_stiffness_Nm_per_rad) / gain * log_uniform(random, 1.01, 50.0);
  motor.kd_range_Nm_s_per_rad =
      std::max(0.1, limits.fault_damping_Nm_s_per_rad) / gain * log_uniform(random, 1.01, 20.0);
  motor.velocity_range_radps = 40.0 * motor.gear_ratio * log_uniform(random, 1.0, 3.0);
  motor.position_range_rad = std::max(12.5, 3.5 * motor.gear_ratio);
  motor.pole_pairs = whole(random, 7, 21);
}

void draw_limits(RobotConfig& robot, Random& random) {
  auto& limits = robot.limits;
  limits.motor_torque_Nm = log_uniform(random, 0.3, 10.0);
  limits.fault_damping_Nm_s_per_rad = chance(random, 0.1) ? 0.0 : log_uniform(random, 0.02, 5.0);
  limits.fault_hold_stiffness_Nm_per_rad = chance(random, 0.1) ? 0.0 : log_uniform(random, 1.0, 500.0);
  limits.fault_damp_s = log_uniform(random, 0.01, 1.0);
  limits.fault_hold_s = log_uniform(random, 0.01, 1.0);
  limits.motor_reply_misses = whole(random, 2, 10);
  limits.strides = whole(random, 1, 5);
  limits.settle_s = log_uniform(random, 0.02, 0.3);
  limits.ramp_down_s = log_uniform(random, 0.05, 1.0);
  if (chance(random, 0.2)) robot.supervision.foot_height_m = 0.03;  // raises a fault with the reaction hold
  robot.supervision.cycle_gap = whole(random, 1, 30);
  robot.supervision.overruns_per_s = 1000;  // otherwise a few gaps would end every trial
}

void draw_law(RobotConfig& robot, Random& random) {
  auto& c = robot.controller;
  c.compression_stiffness_N_per_m = log_uniform(random, 50.0, 5000.0);
  c.extension_stiffness_N_per_m = log_uniform(random, 50.0, 5000.0);
  c.flight_stiffness_N_per_m = log_uniform(random, 100.0, 5000.0);
  c.stance_damping_N_s_per_m = chance(random, 0.5) ? 0.0 : log_uniform(random, 1.0, 500.0);
  c.flight_damping_N_s_per_m = log_uniform(random, 5.0, 500.0);
  c.soft_stop_damping_N_s_per_m = log_uniform(random, 10.0, 500.0);
}

}  // namespace

double log_uniform(Random& random, double low, double high) {
  return low * std::pow(high / low, random.uniform());
}

int whole(Random& random, int low, int high) {
  return low + static_cast<int>(random.uniform() * (high - low + 1));
}

RobotConfig random_robot(const RobotConfig& shipped, Random& random) {
  RobotConfig robot = shipped;
  draw_limits(robot, random);
  if (chance(random, 0.5)) draw_law(robot, random);
  const auto dialect = static_cast<Dialect>(whole(random, 0, 2));
  for (std::size_t i = 0; i < kMotorCount; ++i) {
    auto& motor = robot.motor[i];
    motor.dialect = chance(random, 0.9) ? dialect : static_cast<Dialect>(whole(random, 0, 2));
    motor.can_id = whole(random, 1, 0x3E) + 0x40 * static_cast<int>(i);
    motor.master_id = chance(random, 0.3) ? 0 : 0x100 + motor.can_id;
    draw_drive(motor, robot.limits, random);
  }
  robot.arming.enable_s = 0.05;
  robot.arming.window_s = 0.05;
  return robot;
}

}  // namespace sandhopper::faults
