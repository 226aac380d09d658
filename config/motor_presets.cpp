#include "config/motor_presets.hpp"

#include <fmt/format.h>

#include <array>

namespace sandhopper {
namespace {

constexpr std::string_view kManual = "CubeMars AK manual V1.0.18, MIT parameter table";
constexpr std::string_view kNameplate =
    "nameplate 60/(2 pi KV), TMotorCANControl mit_can.py; 13-20 % off is normal";
constexpr std::string_view kName = "the number behind the dash";

constexpr std::array kPresets{
    MotorPreset{"AK60-6",
                "TMotorCANControl uses 50 rad/s",
                {45.0, kManual},
                {15.0, kManual},
                {0.068, kNameplate},
                {6.0, kName},
                {14.0, "CubeMars parameter file of the AKA60-6"}},
    MotorPreset{
        "AK80-6",
        "measured: 22.5 rad/s on board V1.1, reversed sign on V1.0 (DFKI mini-cheetah-tmotor-python-can)",
        {76.0, kManual},
        {12.0, kManual},
        {0.091, kNameplate},
        {6.0, kName},
        {std::nullopt, ""}},
    MotorPreset{"AK80-9",
                "measured: 25.64 rad/s on board V2 (DFKI), 0.115 N m/A (TMotorCANControl): calibrate both",
                {50.0, kManual},
                {18.0, kManual},
                {0.091, kNameplate},
                {9.0, kName},
                {21.0, "TMotorCANControl servo_can.py"}},
    MotorPreset{"AK10-9",
                "board V3: 28 rad/s and 54 N m (AKA manual V3.0.0)",
                {50.0, kManual},
                {65.0, kManual},
                {0.16, kNameplate},
                {9.0, kName},
                {std::nullopt, ""}},
    MotorPreset{"R80 KV110",
                "a motor without drive: dialect and ranges are those of the board it is wired to",
                {std::nullopt, ""},
                {std::nullopt, ""},
                {0.0868, "60/(2 pi 110); 0.0752 per q-axis ampere of peak phase current"},
                {1.0, "no gearbox"},
                {21.0, "36N42P winding"}}};

void add(std::string& text, std::string_view key, const SourcedValue& v, double factor = 1.0) {
  if (v.value)
    text += fmt::format("{} = {:g}  # {}\n", key, factor * *v.value, v.source);
  else
    text += fmt::format("# {}: not published; read it from the drive, or measure it\n", key);
}

}  // namespace

std::span<const MotorPreset> motor_presets() { return kPresets; }

std::string to_toml(const MotorPreset& p) {
  std::string text = fmt::format("# {}; {}\n", p.name, p.remark);
  if (p.velocity_range_radps.value)
    text += fmt::format(
        "position_range_rad = 12.5  # {0}\nkp_range_Nm_per_rad = 500.0  # {0}\nkd_range_Nm_s_per_rad = 5.0  "
        "# {0}\n",
        kManual);
  add(text, "velocity_range_radps", p.velocity_range_radps);
  add(text, "torque_range_Nm", p.torque_range_Nm);
  const double reduction = p.drive_reduction.value.value_or(1.0);
  add(text, "torque_constant_Nm_per_A", p.motor_torque_constant_Nm_per_A, reduction);
  add(text, "drive_torque_constant_Nm_per_A", p.motor_torque_constant_Nm_per_A, reduction);
  add(text, "drive_reduction", p.drive_reduction);
  add(text, "pole_pairs", p.pole_pairs);
  return text;
}

}  // namespace sandhopper
