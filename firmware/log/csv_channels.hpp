#pragma once
#include <array>
#include <cstdint>
#include <string_view>

#include "firmware/log/topics.hpp"

// Maps each column of a trial's CSV to a field of a topic.
namespace sandhopper {

// Condition for filling a cell; without it the cell is empty although the record exists.
enum class CsvCell : std::uint8_t {
  always,
  fresh,    // `guard` is true
  good,     // `guard` is true and the field `status` beside the value is 0
  served,   // `guard` is true and the estimator runs; in idle and fault states the value is old
  changed,  // `guard` differs from the previous row
  phase     // a number derived from the name of the state
};

struct CsvChannel {
  std::string_view name;
  std::string_view topic;
  std::string_view path;
  CsvCell when = CsvCell::always;
  std::string_view guard{};
  bool optional = false;
};

inline constexpr std::array kCsvChannels{
    CsvChannel{"motor_left_position_rad", topic::kFrame, "motor.0.position_rad", CsvCell::fresh,
               "motor.0.fresh"},
    CsvChannel{"motor_left_velocity_radps", topic::kFrame, "motor.0.velocity_radps", CsvCell::fresh,
               "motor.0.fresh"},
    CsvChannel{"motor_left_current_A", topic::kFrame, "motor.0.current_A", CsvCell::fresh, "motor.0.fresh"},
    CsvChannel{"motor_left_temperature_C", topic::kFrame, "motor.0.temperature_C", CsvCell::fresh,
               "motor.0.fresh"},
    CsvChannel{"motor_right_position_rad", topic::kFrame, "motor.1.position_rad", CsvCell::fresh,
               "motor.1.fresh"},
    CsvChannel{"motor_right_velocity_radps", topic::kFrame, "motor.1.velocity_radps", CsvCell::fresh,
               "motor.1.fresh"},
    CsvChannel{"motor_right_current_A", topic::kFrame, "motor.1.current_A", CsvCell::fresh, "motor.1.fresh"},
    CsvChannel{"motor_right_temperature_C", topic::kFrame, "motor.1.temperature_C", CsvCell::fresh,
               "motor.1.fresh"},
    CsvChannel{"command_left_torque_Nm", topic::kOutput, "command.motor.0.torque_Nm"},
    CsvChannel{"command_right_torque_Nm", topic::kOutput, "command.motor.1.torque_Nm"},
    CsvChannel{"imu_body_accel_z_mps2", topic::kFrame, "imu_body.accel_mps2.2", CsvCell::fresh,
               "imu_body.fresh"},
    CsvChannel{"imu_foot_accel_z_mps2", topic::kFrame, "imu_foot.accel_mps2.2", CsvCell::fresh,
               "imu_foot.fresh"},
    CsvChannel{"tof_height_m", topic::kFrame, "tof.height_m", CsvCell::good, "tof.fresh"},
    CsvChannel{"load_cell_force_N", topic::kOutput, "estimate.load_cell_force_N", CsvCell::served,
               "load_cell.fresh"},
    CsvChannel{"mocap_body_z_m", topic::kTruth, "mocap_body_z_m", CsvCell::changed, "mocap_time_ns"},
    CsvChannel{"mocap_foot_z_m", topic::kTruth, "mocap_foot_z_m", CsvCell::changed, "mocap_time_ns"},
    CsvChannel{"phase", topic::kOutput, "state", CsvCell::phase},
    CsvChannel{"imu_body_gyro_x_radps", topic::kFrame, "imu_body.gyro_radps.0", CsvCell::fresh,
               "imu_body.fresh", true},
    CsvChannel{"imu_body_gyro_y_radps", topic::kFrame, "imu_body.gyro_radps.1", CsvCell::fresh,
               "imu_body.fresh", true},
    CsvChannel{"imu_body_gyro_z_radps", topic::kFrame, "imu_body.gyro_radps.2", CsvCell::fresh,
               "imu_body.fresh", true},
    CsvChannel{"imu_foot_gyro_x_radps", topic::kFrame, "imu_foot.gyro_radps.0", CsvCell::fresh,
               "imu_foot.fresh", true},
    CsvChannel{"imu_foot_gyro_y_radps", topic::kFrame, "imu_foot.gyro_radps.1", CsvCell::fresh,
               "imu_foot.fresh", true},
    CsvChannel{"imu_foot_gyro_z_radps", topic::kFrame, "imu_foot.gyro_radps.2", CsvCell::fresh,
               "imu_foot.fresh", true},
    CsvChannel{"bus_voltage_V", topic::kFrame, "motor.0.bus_voltage_V", CsvCell::fresh, "motor.0.fresh",
               true},
    CsvChannel{"estimate_body_z_m", topic::kOutput, "estimate.body_z_m", CsvCell::always, "", true},
    CsvChannel{"estimate_foot_z_m", topic::kOutput, "estimate.foot_z_m", CsvCell::always, "", true},
    CsvChannel{"estimate_body_velocity_mps", topic::kOutput, "estimate.body_velocity_mps", CsvCell::always,
               "", true},
    CsvChannel{"estimate_foot_velocity_mps", topic::kOutput, "estimate.foot_velocity_mps", CsvCell::always,
               "", true},
    CsvChannel{"estimate_contact_force_N", topic::kOutput, "estimate.contact_force_N", CsvCell::always, "",
               true},
    CsvChannel{"quasi_static_force_N", topic::kOutput, "estimate.quasi_static_force_N", CsvCell::always, "",
               true}};

inline constexpr std::array<std::string_view, 2> kCsvUnservedStates{"STATE_IDLE", "STATE_FAULT"};

// The index of the state's constant in this list is the value of `phase`.
inline constexpr std::array<std::string_view, 3> kCsvPhases{"STATE_FLIGHT", "STATE_COMPRESSION",
                                                            "STATE_EXTENSION"};
// Names of the phases in the same order, as `hop export` can write them.
inline constexpr std::array<std::string_view, 3> kCsvPhaseNames{"flight", "compression", "extension"};

}  // namespace sandhopper
