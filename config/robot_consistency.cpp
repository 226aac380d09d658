#include <algorithm>
#include <cmath>

#include "config/consistency.hpp"
#include "config/contradiction_list.hpp"

namespace sandhopper {
namespace {

constexpr double kCycle_s = 1e-3;
// The thermal model's explicit steps must stay within 5 % of a time constant.
constexpr double kThermalSteps = 20.0;

// Checks that the MIT fields of a drive can represent everything that the cycle commands and supervises, on
// the drive's side.
void check_mit_fields(ContradictionList& list, const CubeMarsConfig& m, const std::string& key,
                      const RobotConfig& c) {
  const auto& limits = c.limits;
  const double torque = m.drive_torque_constant_Nm_per_A / (m.torque_constant_Nm_per_A * m.gear_ratio);
  const double gain = torque / m.gear_ratio;
  const auto written = [](double value) { return fmt::format("{:g}", value); };
  list.carries({key + "torque_range_Nm",
                written(m.torque_range_Nm),
                m.torque_range_Nm,
                {"limits.motor_torque_Nm", limits.motor_torque_Nm},
                limits.motor_torque_Nm * torque,
                "N m",
                "raise the range, in the drive too, or lower the limit"});
  list.carries({key + "kp_range_Nm_per_rad",
                written(m.kp_range_Nm_per_rad),
                m.kp_range_Nm_per_rad,
                {"limits.fault_hold_stiffness_Nm_per_rad", limits.fault_hold_stiffness_Nm_per_rad},
                limits.fault_hold_stiffness_Nm_per_rad * gain,
                "N m/rad",
                "raise the range, in the drive too, or hold more softly"});
  list.carries({key + "kd_range_Nm_s_per_rad",
                written(m.kd_range_Nm_s_per_rad),
                m.kd_range_Nm_s_per_rad,
                {"limits.fault_damping_Nm_s_per_rad", limits.fault_damping_Nm_s_per_rad},
                limits.fault_damping_Nm_s_per_rad * gain,
                "N m s/rad",
                "raise the range, in the drive too, or damp less"});
  list.carries({key + "velocity_range_radps",
                written(m.velocity_range_radps),
                m.velocity_range_radps,
                {"limits.motor_speed_radps", limits.motor_speed_radps},
                limits.motor_speed_radps * m.gear_ratio,
                "rad/s",
                "raise the range, in the drive too, or lower the limit"});
  list.carries({key + "torque_range_Nm",
                fmt::format("{:g} at drive_torque_constant_Nm_per_A = {:g}", m.torque_range_Nm,
                            m.drive_torque_constant_Nm_per_A),
                m.torque_range_Nm / m.drive_torque_constant_Nm_per_A,
                {"supervision.motor_current_A", c.supervision.motor_current_A},
                c.supervision.motor_current_A,
                "A",
                "a reply cannot show a current over the limit: raise the range or lower the limit"});
}

void check_position_range(ContradictionList& list, const CubeMarsConfig& m, const std::string& key,
                          const LimitsConfig& limits) {
  const double usable = kUsablePositionShare * m.position_range_rad;
  for (const auto& [name, angle] : {std::pair{"limits.leg_angle_min_rad", limits.leg_angle_min_rad},
                                    std::pair{"limits.leg_angle_max_rad", limits.leg_angle_max_rad}}) {
    const double drive_rad = std::abs(angle - m.zero_offset_rad) * m.gear_ratio;
    list.carries({key + "position_range_rad",
                  fmt::format("{:g}, of which 88 % are used,", m.position_range_rad),
                  usable,
                  {name, angle},
                  drive_rad,
                  "rad",
                  fmt::format("with zero_offset_rad = {:g} and gear_ratio = {:g}; raise the range or set the "
                              "drive's zero nearer to the leg's angles",
                              m.zero_offset_rad, m.gear_ratio)});
  }
}

void check_motor(ContradictionList& list, const RobotConfig& c, std::size_t i) {
  const auto& m = c.motor[i];
  const auto key = fmt::format("motor[{}].", i);
  const double current_A = c.limits.motor_torque_Nm / m.torque_constant_Nm_per_A;
  if (m.dialect == Dialect::servo) {
    list.carries({key + "torque_constant_Nm_per_A",
                  fmt::format("{:g} with the {:g} A of a servo-mode frame", m.torque_constant_Nm_per_A,
                              kServoCurrentRange_A),
                  kServoCurrentRange_A * m.torque_constant_Nm_per_A * m.gear_ratio,
                  {"limits.motor_torque_Nm", c.limits.motor_torque_Nm},
                  c.limits.motor_torque_Nm,
                  "N m",
                  "lower the limit"});
  } else {
    check_mit_fields(list, m, key, c);
    check_position_range(list, m, key, c.limits);
  }
  list.carries({"supervision.motor_current_A",
                fmt::format("{:g} at {}torque_constant_Nm_per_A = {:g}", c.supervision.motor_current_A, key,
                            m.torque_constant_Nm_per_A),
                c.supervision.motor_current_A * m.torque_constant_Nm_per_A * m.gear_ratio,
                {"limits.motor_torque_Nm", c.limits.motor_torque_Nm},
                c.limits.motor_torque_Nm,
                "N m",
                fmt::format("a torque that is allowed needs {:.3g} A: raise the current limit or lower the "
                            "torque",
                            current_A / m.gear_ratio)});
  if (m.dialect == Dialect::mit && m.reply == ReplyFlavour::bus_voltage)
    list.below({"supervision.bus_voltage_max_V", c.supervision.bus_voltage_max_V},
               {key + "reply = \"bus_voltage\", full scale", kBusVoltageRange_V},
               "a supply over the limit would not be seen");
  const double turns = m.gear_ratio * m.drive_reduction;
  list.add_if(
      std::abs(turns - c.robot.gear_ratio) > 0.01 * turns, "robot.gear_ratio",
      fmt::format("{:g} motor turns per turn of the link, {}gear_ratio = {:g} times drive_reduction = "
                  "{:g} make {:g}: correct the one that is wrong",
                  c.robot.gear_ratio, key, m.gear_ratio, m.drive_reduction, turns));
  const double gap_cycles = std::ceil(1.0 / (kCycle_s * replies_per_s(m)) - 1e-9);
  list.carries({"limits.motor_reply_misses",
                fmt::format("{}", c.limits.motor_reply_misses),
                static_cast<double>(c.limits.motor_reply_misses),
                {key + "status_rate_Hz", replies_per_s(m)},
                gap_cycles,
                "cycles",
                "a drive that keeps its rate would be called lost: raise the limit"});
}

void check_detectors(ContradictionList& list, const RobotConfig& c) {
  const auto& s = c.supervision;
  const auto& l = c.limits;
  list.below({"supervision.motor_torque_error_Nm", s.motor_torque_error_Nm},
             {"limits.motor_torque_Nm", l.motor_torque_Nm},
             "a drive that gives no torque at all would not be noticed");
  list.below({"supervision.motor_velocity_error_radps", s.motor_velocity_error_radps},
             {"limits.motor_speed_radps", l.motor_speed_radps},
             "a drive that reports no velocity at all would not be noticed");
  list.below({"supervision.load_cell_error_N", s.load_cell_error_N},
             {"supervision.load_cell_range_N", s.load_cell_range_N},
             "a load cell that reads nothing at all would not be noticed");
  list.below({"arming.still_range_rad", c.arming.still_range_rad},
             {"arming.zero_tolerance_rad", c.arming.zero_tolerance_rad},
             "a leg that moves through its tolerance would count as still");
  list.below({"supervision.ambient_C", s.ambient_C}, {"limits.motor_temperature_C", l.motor_temperature_C},
             "a cold drive would be over its limit");
  list.below({"supervision.ambient_C", s.ambient_C},
             {"supervision.winding_temperature_C", s.winding_temperature_C},
             "a cold winding would be over its limit");
  list.below({"limits.settle_s", l.settle_s}, {"limits.phase_time_s", l.phase_time_s},
             "a robot that comes to rest would be called stuck before it is called still");
  list.add_if(
      l.strides > s.hop_count, "limits.strides",
      fmt::format("{} is more than supervision.hop_count = {}: the trial would end in hop_count_limit",
                  l.strides, s.hop_count));
}

// Checks that a sensor at the lowest accepted rate can keep the age limit: one period plus one cycle.
void check_ages(ContradictionList& list, const RobotConfig& c) {
  struct Sensor {
    const char* age_key;
    double age_s;
    const char* rate_key;
    double rate_Hz;
  };
  const auto& s = c.supervision;
  for (const auto& sensor :
       {Sensor{"limits.imu_age_s", c.limits.imu_age_s, "supervision.imu_rate_Hz", s.imu_rate_Hz},
        Sensor{"limits.tof_age_s", c.limits.tof_age_s, "supervision.tof_rate_Hz", s.tof_rate_Hz},
        Sensor{"limits.load_cell_age_s", c.limits.load_cell_age_s, "supervision.load_cell_rate_Hz",
               s.load_cell_rate_Hz}}) {
    if (sensor.rate_Hz <= 0.0) continue;
    list.carries({sensor.age_key,
                  fmt::format("{:g}", sensor.age_s),
                  sensor.age_s,
                  {sensor.rate_key, sensor.rate_Hz},
                  1.0 / sensor.rate_Hz + kCycle_s,
                  "s",
                  "a sensor that keeps the rate would be called stale: raise the age or the rate"});
  }
}

void check_thermal_model(ContradictionList& list, const RobotConfig& c) {
  const auto& s = c.supervision;
  const double step_s = kCycle_s * (s.cycle_gap + 1);  // longest step that is not a fault
  const auto check = [&](const std::string& part, double resistance, double capacity) {
    list.carries({"supervision." + part + "_capacity_J_per_K",
                  fmt::format("{:g} with {}_resistance_K_per_W = {:g}", capacity, part, resistance),
                  resistance * capacity,
                  {"supervision.cycle_gap", static_cast<double>(s.cycle_gap)},
                  kThermalSteps * step_s,
                  "s of time constant",
                  "the thermal model's steps would be too long: no motor is so small"});
  };
  check("winding", s.winding_resistance_K_per_W, s.winding_capacity_J_per_K);
  check("housing", s.housing_resistance_K_per_W, s.housing_capacity_J_per_K);
}

void check_watchdogs(ContradictionList& list, const RobotConfig& c) {
  const double gap_s = kCycle_s * (c.supervision.cycle_gap + 1);
  list.carries({"supervision.cycle_gap",
                fmt::format("{} (a fault after {:g} s)", c.supervision.cycle_gap, gap_s),
                gap_s,
                {"watchdog.cycle_stall_s", c.watchdog.cycle_stall_s},
                c.watchdog.cycle_stall_s,
                "s",
                "torque would stand uncut through a gap that is a fault: lower cycle_stall_s or raise "
                "cycle_gap"});
  if (!c.watchdog.device.empty())
    list.below({"watchdog.cycle_stall_s", c.watchdog.cycle_stall_s},
               {"watchdog.device_timeout_s", static_cast<double>(c.watchdog.device_timeout_s)},
               "the computer would be reset before the torque is cut");
}

void check_motion(ContradictionList& list, const RobotConfig& c, const Leg& leg) {
  const auto& s = c.supervision;
  for (const auto& [name, length] :
       {std::pair{"arming.zero_pose_length_m", c.arming.zero_pose_length_m},
        std::pair{"controller.compression_length_m", c.controller.compression_length_m},
        std::pair{"controller.extension_length_m", c.controller.extension_length_m}}) {
    list.below({"supervision.leg_length_min_m", s.leg_length_min_m}, {name, length},
               "the leg would be too short where it must go");
    list.below({name, length}, {"supervision.leg_length_max_m", s.leg_length_max_m},
               "the leg would be too long where it must go");
  }
  const double fall_mps = std::sqrt(2.0 * kGravity_mps2 * s.foot_height_m);
  list.carries({"supervision.body_speed_mps",
                fmt::format("{:g}", s.body_speed_mps),
                s.body_speed_mps,
                {"supervision.foot_height_m", s.foot_height_m},
                fall_mps,
                "m/s",
                "a fall from an allowed height would be a fault: raise the speed or lower the height"});
  const auto at_touchdown = leg.kinematics(leg.angle_at_length(c.controller.compression_length_m));
  const double lever_m = std::abs(at_touchdown.dlength_m_per_rad);
  list.carries({"limits.motor_speed_radps",
                fmt::format("{:g} at a lever of {:.3g} m", c.limits.motor_speed_radps, lever_m),
                c.limits.motor_speed_radps * lever_m,
                {"supervision.foot_height_m", s.foot_height_m},
                fall_mps,
                "m/s",
                "a landing from an allowed height would be a fault: raise the speed or lower the "
                "height"});
  const double weight_N = leg.total_mass_kg() * kGravity_mps2;
  const double motors = c.robot.motor_count;
  list.carries({"limits.motor_torque_Nm",
                fmt::format("{:g}", c.limits.motor_torque_Nm),
                motors * c.limits.motor_torque_Nm / lever_m,
                {"the robot's weight", weight_N},
                weight_N,
                "N",
                "the leg cannot carry the robot at compression_length_m: raise the limit"});
  const double highest_m = s.leg_length_max_m + c.robot.foot_height_m + s.foot_height_m;
  list.carries(
      {"supervision.tof_range_m",
       fmt::format("{:g}", s.tof_range_m),
       s.tof_range_m,
       {"supervision.foot_height_m", s.foot_height_m},
       highest_m,
       "m",
       "with leg_length_max_m and robot.foot_height_m, the body's greatest allowed height; raise the "
       "range"});
}

}  // namespace

std::vector<Contradiction> contradictions(const RobotConfig& robot) {
  ContradictionList list;
  for (std::size_t i = 0; i < static_cast<std::size_t>(robot.robot.motor_count); ++i)
    check_motor(list, robot, i);
  check_detectors(list, robot);
  check_ages(list, robot);
  check_thermal_model(list, robot);
  check_watchdogs(list, robot);
  check_motion(list, robot, Leg(robot.robot));
  return list.take();
}

}  // namespace sandhopper
