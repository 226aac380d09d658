#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <ostream>

#include "config/consistency.hpp"
#include "config/edit.hpp"
#include "config/files.hpp"
#include "config/load.hpp"

// Every pair of values that can contradict each other, tested on both sides: the first setting is just valid,
// the second just invalid and refused at its key.
namespace sandhopper {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

const std::filesystem::path kConfig = std::filesystem::path(SANDHOPPER_SOURCE_DIR) / "config";

struct Configuration {
  RobotConfig robot{};
  LinuxBoardConfig board{};
};

struct Pair {
  const char* name;
  std::function<void(Configuration&, double)> set;
  double right;
  double wrong;
  const char* key;   // key that the message must name
  const char* says;  // text that the message must contain
};

void PrintTo(const Pair& pair, std::ostream* out) { *out << pair.name; }

std::vector<Contradiction> found_in(const Configuration& c) {
  auto found = contradictions(c.robot);
  for (const auto& of_board : contradictions(c.board, c.robot)) found.push_back(of_board);
  return found;
}

#define SET(expression) \
  [](Configuration& c, double x) { c.expression = static_cast<decltype(c.expression)>(x); }

// A servo-mode drive at 500 Hz, with limits that fit it.
void make_servo(Configuration& c) {
  for (auto& motor : c.robot.motor) motor.dialect = Dialect::servo;
}

// An HX711 at 80 conversions a second, with limits that fit it.
void make_iio(Configuration& c) {
  c.board.load_cell.converter = LoadCellConverter::iio;
  c.board.load_cell.iio = IioConverterConfig{};
  c.robot.supervision.load_cell_rate_Hz = 80.0;
}

const Pair kPairs[] = {
    // A drive's range must include the limits of the controller, on the drive's side of gear and torque
    // constant.
    {"TorqueRangeTorqueLimit", SET(robot.motor[1].torque_range_Nm), 4.0, 2.7, "motor[1].torque_range_Nm",
     "2.7 carries 2.7 N m, limits.motor_torque_Nm = 2.8 asks for 2.8"},
    {"TorqueLimitTorqueRange", SET(robot.limits.motor_torque_Nm), 3.9, 18.1, "motor[0].torque_range_Nm",
     "N m"},
    {"TorqueRangeThroughTheDrivesConstant", SET(robot.motor[0].drive_torque_constant_Nm_per_A), 0.3, 0.6,
     "motor[0].torque_range_Nm", "18 carries 18 N m, limits.motor_torque_Nm = 2.8 asks for 19.35"},
    {"TorqueRangeCurrentLimit", SET(robot.supervision.motor_current_A), 207.0, 208.0,
     "motor[0].torque_range_Nm", "carries 207.4 A, supervision.motor_current_A = 208 asks for 208"},
    {"KpRangeHold", SET(robot.motor[0].kp_range_Nm_per_rad), 15.0, 14.9, "motor[0].kp_range_Nm_per_rad",
     "limits.fault_hold_stiffness_Nm_per_rad = 15 asks for 15"},
    {"HoldKpRange", SET(robot.limits.fault_hold_stiffness_Nm_per_rad), 500.0, 501.0,
     "motor[1].kp_range_Nm_per_rad", "500 carries 500"},
    {"KdRangeDamping", SET(robot.motor[0].kd_range_Nm_s_per_rad), 0.3, 0.29, "motor[0].kd_range_Nm_s_per_rad",
     "limits.fault_damping_Nm_s_per_rad = 0.3 asks for 0.3"},
    {"DampingKdRange", SET(robot.limits.fault_damping_Nm_s_per_rad), 5.0, 5.1,
     "motor[0].kd_range_Nm_s_per_rad", "5 carries 5"},
    {"VelocityRangeSpeedLimit", SET(robot.motor[0].velocity_range_radps), 40.0, 39.0,
     "motor[0].velocity_range_radps", "limits.motor_speed_radps = 40 asks for 40"},
    {"SpeedLimitVelocityRange", SET(robot.limits.motor_speed_radps), 50.0, 50.5,
     "motor[0].velocity_range_radps", "50 carries 50"},
    {"PositionRangeLegAngle", SET(robot.motor[0].position_range_rad), 3.07, 3.06,
     "motor[0].position_range_rad", "limits.leg_angle_max_rad = 2.7 asks for 2.7"},
    {"LegAngleThroughTheZero", SET(robot.motor[0].zero_offset_rad), -8.2, -8.4, "motor[0].position_range_rad",
     "carries 11 rad, limits.leg_angle_max_rad = 2.7 asks for 11.1"},
    {"CurrentLimitTorqueLimit", SET(robot.supervision.motor_current_A), 32.3, 32.2,
     "supervision.motor_current_A", "carries 2.795 N m, limits.motor_torque_Nm = 2.8 asks for 2.8"},
    {"ServoCurrentTorqueLimit",
     [](Configuration& c, double x) {
       make_servo(c);
       c.robot.supervision.motor_current_A = 100.0;
       c.robot.limits.motor_torque_Nm = x;
     },
     5.2, 5.3, "motor[0].torque_constant_Nm_per_A", "carries 5.208 N m, limits.motor_torque_Nm = 5.3"},
    {"ServoRateReplyMisses",
     [](Configuration& c, double x) {
       make_servo(c);
       c.robot.limits.motor_reply_misses = static_cast<int>(x);
     },
     2, 1, "limits.motor_reply_misses", "1 carries 1 cycles, motor[0].status_rate_Hz = 500 asks for 2"},
    {"VoltageLimitReply",
     [](Configuration& c, double x) {
       c.robot.motor[0].reply = ReplyFlavour::bus_voltage;
       c.robot.supervision.bus_voltage_max_V = x;
     },
     39.0, 40.0, "supervision.bus_voltage_max_V", "a supply over the limit would not be seen"},
    {"GearRatioOfTheRobotAndItsMotor", SET(robot.motor[0].drive_reduction), 1.005, 6.0, "robot.gear_ratio",
     "drive_reduction = 6 make 6"},
    // Limits with which a detector could never fire.
    {"TorqueErrorTorqueLimit", SET(robot.supervision.motor_torque_error_Nm), 2.7, 2.8,
     "supervision.motor_torque_error_Nm", "less than limits.motor_torque_Nm = 2.8"},
    {"VelocityErrorSpeedLimit", SET(robot.supervision.motor_velocity_error_radps), 39.0, 40.0,
     "supervision.motor_velocity_error_radps", "less than limits.motor_speed_radps = 40"},
    {"LoadCellErrorLoadCellRange", SET(robot.supervision.load_cell_error_N), 249.0, 250.0,
     "supervision.load_cell_error_N", "less than supervision.load_cell_range_N = 250"},
    {"StillRangeZeroTolerance", SET(robot.arming.still_range_rad), 0.029, 0.03, "arming.still_range_rad",
     "less than arming.zero_tolerance_rad = 0.03"},
    {"AmbientMotorTemperature", SET(robot.limits.motor_temperature_C), 26.0, 25.0, "supervision.ambient_C",
     "less than limits.motor_temperature_C = 25"},
    {"AmbientWindingTemperature", SET(robot.supervision.winding_temperature_C), 110.0, 25.0,
     "supervision.ambient_C", "less than supervision.winding_temperature_C = 25"},
    {"SettlePhaseTime", SET(robot.limits.phase_time_s), 0.21, 0.2, "limits.settle_s",
     "less than limits.phase_time_s = 0.2"},
    {"StridesHopCount", SET(robot.limits.strides), 100000, 100001, "limits.strides",
     "supervision.hop_count = 100000"},
    // Ages and rates.
    {"ImuAgeImuRate", SET(robot.limits.imu_age_s), 0.0025, 0.0022, "limits.imu_age_s",
     "supervision.imu_rate_Hz = 800 asks for 0.00225"},
    {"TofAgeTofRate", SET(robot.supervision.tof_rate_Hz), 11.0, 10.0, "limits.tof_age_s",
     "supervision.tof_rate_Hz = 10 asks for 0.101"},
    {"LoadCellAgeLoadCellRate", SET(robot.limits.load_cell_age_s), 0.003, 0.0026, "limits.load_cell_age_s",
     "supervision.load_cell_rate_Hz = 600 asks for 0.002667"},
    // Thermal model, watchdogs.
    {"WindingTimeConstantStep", SET(robot.supervision.winding_resistance_K_per_W), 0.011, 0.01,
     "supervision.winding_capacity_J_per_K",
     "carries 0.4 s of time constant, supervision.cycle_gap = 20 asks for 0.42"},
    {"HousingTimeConstantStep", SET(robot.supervision.housing_capacity_J_per_K), 1.0, 0.2,
     "supervision.housing_capacity_J_per_K", "carries 0.4 s of time constant"},
    {"StallCycleGap", SET(robot.watchdog.cycle_stall_s), 0.021, 0.022, "supervision.cycle_gap",
     "carries 0.021 s, watchdog.cycle_stall_s = 0.022 asks for 0.022"},
    {"CycleGapStall", SET(robot.supervision.cycle_gap), 19, 18, "supervision.cycle_gap", "carries 0.019 s"},
    {"StallDeviceTimeout",
     [](Configuration& c, double x) {
       c.robot.supervision.cycle_gap = 1000;
       c.robot.watchdog.cycle_stall_s = x;
       c.robot.watchdog.device_timeout_s = 1;
     },
     0.999, 1.0, "watchdog.cycle_stall_s", "reset before the torque is cut"},
    // The robot as a whole.
    {"LegMinZeroPose", SET(robot.supervision.leg_length_min_m), 0.29, 0.30, "supervision.leg_length_min_m",
     "less than arming.zero_pose_length_m = 0.3"},
    {"LegMinCompression",
     [](Configuration& c, double x) {
       c.robot.arming.zero_pose_length_m = 0.33;
       c.robot.supervision.leg_length_min_m = x;
     },
     0.29, 0.30, "supervision.leg_length_min_m", "less than controller.compression_length_m = 0.3"},
    {"ZeroPoseLegMax",
     [](Configuration& c, double x) {
       c.robot.controller.extension_length_m = 0.31;
       c.robot.supervision.leg_length_max_m = 0.32;
       c.robot.arming.zero_pose_length_m = x;
     },
     0.319, 0.32, "arming.zero_pose_length_m", "less than supervision.leg_length_max_m = 0.32"},
    {"ExtensionLegMax", SET(robot.supervision.leg_length_max_m), 0.341, 0.34, "controller.extension_length_m",
     "less than supervision.leg_length_max_m = 0.34"},
    {"BodySpeedFootHeight", SET(robot.supervision.body_speed_mps), 2.22, 2.21, "supervision.body_speed_mps",
     "supervision.foot_height_m = 0.25 asks for 2.215"},
    {"FootHeightBodySpeed", SET(robot.supervision.foot_height_m), 0.6, 0.63, "supervision.body_speed_mps",
     "supervision.foot_height_m = 0.63 asks for 3.516"},
    {"MotorSpeedFootHeight", SET(robot.limits.motor_speed_radps), 25.0, 5.0, "limits.motor_speed_radps",
     "a landing from an allowed height would be a fault"},
    {"TorqueLimitWeight", SET(robot.limits.motor_torque_Nm), 2.0, 1.0, "limits.motor_torque_Nm",
     "cannot carry the robot"},
    {"TofLimitHeight", SET(robot.supervision.tof_range_m), 0.74, 0.72, "supervision.tof_range_m",
     "supervision.foot_height_m = 0.25 asks for 0.7295"},
    // Devices against the robot.
    {"AccelRangeBody", SET(board.imu_body.accel_range_g), 16, 4, "imu_body.accel_range_g",
     "carries 39.23 m/s2, supervision.imu_range_mps2 = 152 asks for 152: raise the range to 16 or lower the "
     "limit"},
    {"AccelRangeFoot", SET(board.imu_foot.accel_range_g), 16, 8, "imu_foot.accel_range_g",
     "carries 78.45 m/s2"},
    {"AccelLimit", SET(robot.supervision.imu_range_mps2), 156.0, 157.0, "imu_body.accel_range_g",
     "lower the limit: the widest range is 16"},
    {"AccelRangeLessItsBias", SET(board.imu_body.accel_bias_mps2[2]), 4.9, 5.0, "imu_body.accel_range_g",
     "carries 151.9 m/s2"},
    {"JointFitAccelRange", SET(robot.stiffness.joint.accel_range_mps2), 156.0, 160.0,
     "imu_foot.accel_range_g", "stiffness.joint.accel_range_mps2 = 160"},
    {"GyroRange", SET(board.imu_foot.gyro_range_dps), 500, 250, "imu_foot.gyro_range_dps",
     "carries 4.363 rad/s, supervision.imu_gyro_radps = 8"},
    {"GyroLimit", SET(robot.supervision.imu_gyro_radps), 34.0, 36.0, "imu_body.gyro_range_dps",
     "carries 34.91 rad/s"},
    {"ImuRate", SET(board.imu_body.rate_Hz), 833, 416, "imu_body.rate_Hz",
     "supervision.imu_rate_Hz = 800 asks for 800"},
    {"ImuLatencyImuAge", SET(board.imu_body.latency_s), 0.008, 0.009, "imu_body.latency_s",
     "limits.imu_age_s = 0.01 carries 0.01 s"},
    {"SpiSpeedImuRate", SET(board.imu_foot.spi_speed_Hz), 500000, 400000, "imu_foot.spi_speed_Hz",
     "imu_foot.rate_Hz = 1666"},
    {"ImuThreadPriority", SET(board.imu_body.thread_priority), 79, 80, "imu_body.thread_priority",
     "less than real_time.priority = 80"},
    {"LoadCellScale", SET(board.load_cell.scale_N_per_V), 62.0, 10.0, "load_cell.scale_N_per_V",
     "10 with 4.096 V of range less zero_V = 0 carries 40.96 N, supervision.load_cell_range_N = 250 asks for "
     "250"},
    {"LoadCellLimit", SET(robot.supervision.load_cell_range_N), 409.0, 410.0, "load_cell.scale_N_per_V",
     "carries 409.6 N"},
    {"LoadCellZero", SET(board.load_cell.zero_V), 1.5, -1.6, "load_cell.scale_N_per_V", "carries 249.6 N"},
    {"LoadCellInputRange", SET(board.load_cell.range), 1, 2, "load_cell.scale_N_per_V", "carries 204.8 N"},
    {"LoadCellRate", SET(board.load_cell.rate), 7, 6, "load_cell.rate",
     "475SPS carries 475 samples a second"},
    {"IioLoadCellRate",
     [](Configuration& c, double x) {
       make_iio(c);
       c.board.load_cell.iio->rate_Hz = x;
     },
     80.0, 79.0, "load_cell.iio.rate_Hz",
     "79 carries 79 samples a second, supervision.load_cell_rate_Hz = 80 asks for 80"},
    {"IioLoadCellLatency",
     [](Configuration& c, double x) {
       make_iio(c);
       c.board.load_cell.latency_s = x;
     },
     0.036, 0.037, "load_cell.latency_s", "limits.load_cell_age_s = 0.05 carries 0.05 s"},
    {"Ads1115RangeIsNoneOfAnIioConverter",
     [](Configuration& c, double x) {
       make_iio(c);
       c.board.load_cell.scale_N_per_V = 10.0;
       if (x == 0.0) c.board.load_cell.converter = LoadCellConverter::ads1115;
     },
     1.0, 0.0, "load_cell.scale_N_per_V", "10 with 4.096 V of range"},
    {"LoadCellLatency", SET(board.load_cell.latency_s), 0.047, 0.048, "load_cell.latency_s",
     "limits.load_cell_age_s = 0.05 carries 0.05 s"},
    {"LoadCellThreadPriority", SET(board.load_cell.thread_priority), 79, 80, "load_cell.thread_priority",
     "less than real_time.priority = 80"},
    {"TofRangeMax", SET(board.tof.range_max_m), 2.5, 2.4, "tof.range_max_m", "supervision.tof_range_m = 2.5"},
    {"TofLimit", SET(robot.supervision.tof_range_m), 3.0, 3.1, "tof.range_max_m", "carries 3 m"},
    {"TofRangeMin", SET(board.tof.range_min_m), 0.19, 0.2, "tof.range_min_m", "lets it come down to 0.195"},
    {"TofRate", SET(board.tof.frame_time_s), 0.0033, 0.0034, "tof.frame_time_s",
     "supervision.tof_rate_Hz = 300"},
    {"TofLatency", SET(robot.limits.tof_age_s), 0.006, 0.0049, "tof.latency_s", "limits.tof_age_s = 0.0049"},
    {"TofThreadPriority", SET(board.tof.thread_priority), 79, 80, "tof.thread_priority",
     "less than real_time.priority = 80"},
    {"BusLoad",
     [](Configuration& c, double x) {
       // the motors come from the robot's file
       for (auto& motor : c.robot.motor) motor.dialect = Dialect::v3;
       c.board.can.other_load = x;
     },
     0.15, 0.2, "can.other_load", "84 %"},
};

#undef SET

class ConfigConsistency : public ::testing::TestWithParam<Pair> {};

TEST_P(ConfigConsistency, JustRightPassesAndJustWrongIsRefusedAtItsKey) {
  const auto& pair = GetParam();
  Configuration right, wrong;
  pair.set(right, pair.right);
  pair.set(wrong, pair.wrong);
  for (const auto& c : found_in(right)) EXPECT_NE(c.key, pair.key) << "refused: " << c.text;
  bool said = false;
  std::string all;
  for (const auto& c : found_in(wrong)) {
    all += c.key + ": " + c.text + "\n";
    said = said || (c.key == pair.key && c.text.find(pair.says) != std::string::npos);
  }
  EXPECT_TRUE(said) << "expected " << pair.key << " … " << pair.says << "\nfound:\n" << all;
}

INSTANTIATE_TEST_SUITE_P(Pairs, ConfigConsistency, ::testing::ValuesIn(kPairs),
                         [](const auto& info) { return info.param.name; });

TEST(ConfigConsistencyFiles, TheShippedFilesAndTheDefaultsContradictNothing) {
  for (const auto& c : found_in({})) ADD_FAILURE() << c.key << ": " << c.text;
  const auto robot = load_robot(kConfig);
  for (const auto* file : {"linux.toml", "bench.toml"})
    EXPECT_NO_THROW(load_linux_board(kConfig / file, robot));
}

std::string refusal(const std::function<void()>& load) {
  try {
    load();
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(ConfigConsistencyFiles, ARefusalNamesFileLineAndArithmetic) {
  const auto folder = std::filesystem::temp_directory_path() / "config_consistency";
  std::filesystem::create_directories(folder);
  const auto edited = [&](const char* name, const char* key, const char* value) {
    auto editor = ConfigEditor::of_file(kConfig / name);
    editor.set(key, value);
    std::filesystem::copy_file(kConfig / name, folder / name,
                               std::filesystem::copy_options::overwrite_existing);
    replace_file(folder / name, editor.text());
    return folder / name;
  };
  EXPECT_THAT(
      refusal([&] { load_linux_board(edited("linux.toml", "imu_body.accel_range_g", "4"), RobotConfig{}); }),
      AllOf(HasSubstr("linux.toml:15:"), HasSubstr("key 'imu_body.accel_range_g' does not fit: 4 g"),
            HasSubstr("supervision.imu_range_mps2 = 152 asks for 152")));
  EXPECT_THAT(
      refusal([&] { load_robot_file(edited("robot.toml", "motor[1].kd_range_Nm_s_per_rad", "0.1")); }),
      AllOf(HasSubstr("robot.toml:"), HasSubstr("key 'motor[1].kd_range_Nm_s_per_rad' does not fit")));
  EXPECT_EQ(refusal([&] { load_file<RobotConfig>((folder / "robot.toml").string()); }), "")
      << "a log's configuration is read without these rules, so that it still replays";
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace sandhopper
