#include "config/robot_config.hpp"

#include <fmt/format.h>

#include <optional>
#include <stdexcept>

namespace sandhopper {
namespace {

using Report = std::function<void(std::string_view, const std::string&)>;

struct Named {
  std::string_view key;
  double value;
};

void expect_below(const Report& report, Named low, Named high) {
  if (low.value < high.value) return;
  report(low.key, fmt::format("expected less than {} ({}), got {}", high.key, high.value, low.value));
}

std::optional<Leg> check_leg(const Report& report, const LegParameters& parameters) {
  const auto& p = parameters;
  if (p.lower_link_length_m <= p.upper_link_length_m + p.hip_offset_m) {
    report("robot.lower_link_length_m",
           fmt::format("expected more than upper_link_length_m + hip_offset_m ({}), or the leg locks, got {}",
                       p.upper_link_length_m + p.hip_offset_m, p.lower_link_length_m));
    return std::nullopt;
  }
  try {
    return Leg(parameters);
  } catch (const std::invalid_argument& error) {
    report("robot", error.what());
    return std::nullopt;
  }
}

// The leg must reach every configured length within its angle limits.
void check_reach(const Report& report, const RobotConfig& c, const Leg& leg) {
  const double longest_m = leg.kinematics(c.limits.leg_angle_min_rad).length_m;
  const double shortest_m = leg.kinematics(c.limits.leg_angle_max_rad).length_m;
  for (const auto& [key, value] :
       {Named{"controller.compression_length_m", c.controller.compression_length_m},
        Named{"controller.extension_length_m", c.controller.extension_length_m},
        Named{"arming.zero_pose_length_m", c.arming.zero_pose_length_m}}) {
    if (value > shortest_m && value < longest_m) continue;
    report(key, fmt::format("expected a length this leg reaches within limits.leg_angle_min_rad and "
                            "leg_angle_max_rad, {:.4f} to {:.4f} m, got {}",
                            shortest_m, longest_m, value));
  }
}

// The torque that confirms motor mode at arming must be below the motors' limit and at least four steps of
// the drives' torque field. Otherwise a reply cannot show it.
void check_confirm_torque(const Report& report, const RobotConfig& c) {
  const double torque_Nm = c.arming.confirm_torque_Nm;
  if (torque_Nm > c.limits.motor_torque_Nm)
    report("arming.confirm_torque_Nm", fmt::format("expected at most limits.motor_torque_Nm ({}), got {}",
                                                   c.limits.motor_torque_Nm, torque_Nm));
  for (const auto& motor : c.motor) {
    const double step_Nm = 2.0 * motor.torque_range_Nm / 4095.0 * motor.gear_ratio;
    if (motor.dialect == Dialect::servo || torque_Nm >= 4.0 * step_Nm) continue;
    report(
        "arming.confirm_torque_Nm",
        fmt::format("expected at least four steps of the torque field of motor \"{}\" (4 x 2 x {} / 4095 x "
                    "gear_ratio = {:.3f} N m), or its reply cannot show it, got {}",
                    motor.name, motor.torque_range_Nm, 4.0 * step_Nm, torque_Nm));
  }
}

}  // namespace

void RobotConfig::check(const Report& report) const {
  const auto leg = check_leg(report, robot);
  check_motors(motor, report);
  check_confirm_torque(report, *this);
  expect_below(report, {"limits.leg_angle_min_rad", limits.leg_angle_min_rad},
               {"limits.leg_angle_max_rad", limits.leg_angle_max_rad});
  if (leg && limits.leg_angle_min_rad < limits.leg_angle_max_rad) check_reach(report, *this, *leg);
  expect_below(report, {"supervision.leg_length_min_m", supervision.leg_length_min_m},
               {"supervision.leg_length_max_m", supervision.leg_length_max_m});
  expect_below(report, {"supervision.bus_voltage_min_V", supervision.bus_voltage_min_V},
               {"supervision.bus_voltage_max_V", supervision.bus_voltage_max_V});
  if (real_time.priority > 0 && watchdog.priority <= real_time.priority)
    report("watchdog.priority",
           fmt::format(
               "expected more than real_time.priority ({}), or a cycle that runs away stops its watchdog, "
               "too, got {}",
               real_time.priority, watchdog.priority));
  if (controller.extension_length_m < controller.compression_length_m)
    report(
        "controller.extension_length_m",
        fmt::format("expected at least compression_length_m ({}), or the leg pulls at the switch instead of "
                    "pushing, got {}",
                    controller.compression_length_m, controller.extension_length_m));
  if (stiffness.weights.sigma_bad_N < stiffness.weights.sigma_good_N)
    report("stiffness.weights.sigma_bad_N",
           fmt::format("expected at least sigma_good_N ({}), got {}", stiffness.weights.sigma_good_N,
                       stiffness.weights.sigma_bad_N));
  expect_below(report, {"stiffness.min_depth_span_m", stiffness.min_depth_span_m},
               {"stiffness.max_depth_m", stiffness.max_depth_m});
}

CycleConfig cycle_config(const RobotConfig& c) {
  CycleConfig cycle;
  cycle.robot = c.robot;
  for (std::size_t i = 0; i < kMotorCount; ++i) {
    cycle.torque_constant_Nm_per_A[i] = c.motor[i].torque_constant_Nm_per_A;
    cycle.motor_reply_rate_Hz[i] = replies_per_s(c.motor[i]);
    cycle.law_in_drive[i] = law_in_drive(c.motor[i]);
  }
  cycle.estimator = c.estimator;
  cycle.controller = c.controller;
  cycle.arming = c.arming;
  cycle.stiffness = c.stiffness;
  cycle.limits = c.limits;
  cycle.supervision = c.supervision;
  return cycle;
}

}  // namespace sandhopper
