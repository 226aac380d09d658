#pragma once
#include "drivers/samples.hpp"
#include "firmware/linux_board_config.hpp"

// What turns a device's raw figures into SI units in the robot's frame: the keys that calibrations change.
// The motors are those of `can.motor`.
namespace sandhopper::calibrate {

// A sample that was made with the configuration `from`, as `to` would have made it of the same raw figures:
// signs, zeros, scales, mounting, and the age that is taken off the time stamp.
MotorSample converted(const MotorSample& sample, const CubeMarsConfig& from, const CubeMarsConfig& to);
ImuSample converted(const ImuSample& sample, const ImuConfig& from, const ImuConfig& to);
TofSample converted(const TofSample& sample, const TofConfig& from, const TofConfig& to);
LoadCellSample converted(const LoadCellSample& sample, const LoadCellConfig& from, const LoadCellConfig& to);

// Voltage at the converter's input that makes this force.
double load_cell_voltage_V(double force_N, const LoadCellConfig& config);

}  // namespace sandhopper::calibrate
