#pragma once
#include "drivers/samples.hpp"
#include "firmware/linux_board_config.hpp"

// Conversions between a device's raw values and SI units in the robot's frame, with the keys that
// calibrations change. The motors are those of `can.motor`.
namespace sandhopper::calibrate {

// Converts a sample made with the configuration `from` to what the configuration `to` makes of the same raw
// values: sign, zero, scale, mounting, and the latency that is subtracted from the time stamp.
MotorSample converted(const MotorSample& sample, const CubeMarsConfig& from, const CubeMarsConfig& to);
ImuSample converted(const ImuSample& sample, const ImuConfig& from, const ImuConfig& to);
TofSample converted(const TofSample& sample, const TofConfig& from, const TofConfig& to);
LoadCellSample converted(const LoadCellSample& sample, const LoadCellConfig& from, const LoadCellConfig& to);

// Voltage at the converter's input for this force.
double load_cell_voltage_V(double force_N, const LoadCellConfig& config);

}  // namespace sandhopper::calibrate
