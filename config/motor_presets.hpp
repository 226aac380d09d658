#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace sandhopper {

// A published value and its source.
struct SourcedValue {
  std::optional<double> value;  // empty: not published
  std::string_view source;
};

// Keys of a [[motor]] table that are determined by the type of motor. Ranges are the full scales of the MIT
// fields.
struct MotorPreset {
  std::string_view name;
  std::string_view remark;
  SourcedValue velocity_range_radps;
  SourcedValue torque_range_Nm;
  SourcedValue motor_torque_constant_Nm_per_A;  // of the motor without its gearbox
  SourcedValue drive_reduction;
  SourcedValue pole_pairs;
};

// AK60-6, AK80-6, AK80-9, AK10-9 and R80 KV110 of CubeMars. Their position range is 12.5 rad; gains range
// from 0 to 500 N m/rad and from 0 to 5 N m s/rad.
std::span<const MotorPreset> motor_presets();

// The keys as lines of robot.toml, each with its source; an unpublished value is a comment. The torque
// constants are those of the output: the motor's times drive_reduction.
std::string to_toml(const MotorPreset& preset);

}  // namespace sandhopper
