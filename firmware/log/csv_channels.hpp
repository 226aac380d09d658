#pragma once
#include <array>
#include <cstdint>
#include <string_view>

#include "firmware/log/topics.hpp"

// Which field of which topic each column of a trial's CSV holds.
namespace sandhopper {

// What makes a cell empty although the record is there.
enum class CsvCell : std::uint8_t {
  always,
  fresh,    // `guard` is true
  good,     // likewise, and the field `status` beside it is 0
  served,   // likewise, and the cycle estimates: idle or in a fault it leaves its last value standing
  changed,  // `guard` differs from the row before
  phase     // not a number of its own: the state's name decides
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

// Value of `phase` by the state's constant in the schema.
inline constexpr std::array<std::string_view, 3> kCsvPhases{"STATE_FLIGHT", "STATE_COMPRESSION",
                                                            "STATE_EXTENSION"};
// The same by name, as `hop export` writes them.
inline constexpr std::array<std::string_view, 3> kCsvPhaseNames{"flight", "compression", "extension"};

}  // namespace sandhopper
