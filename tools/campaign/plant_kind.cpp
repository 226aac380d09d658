#include "tools/campaign/plant_kind.hpp"

#include <algorithm>

namespace sandhopper {
namespace {

using enum CampaignPlant;
using enum MayRest;

constexpr bool kRange = true;
// Current and speed of a motor have no kRange: at the drive's limit they still are true values.
constexpr std::array kChannels{
    ChannelTraits{"motor_left_position_rad", hopper}, ChannelTraits{"motor_right_position_rad", hopper},
    ChannelTraits{"motor_left_velocity_radps", hopper, at_zero},
    ChannelTraits{"motor_right_velocity_radps", hopper, at_zero},
    ChannelTraits{"motor_left_current_A", hopper, at_zero},
    ChannelTraits{"motor_right_current_A", hopper, at_zero},
    ChannelTraits{"motor_left_temperature_C", hopper, always},
    ChannelTraits{"motor_right_temperature_C", hopper, always},
    ChannelTraits{"command_left_torque_Nm", hopper, always},
    ChannelTraits{"command_right_torque_Nm", hopper, always},
    ChannelTraits{"imu_body_accel_z_mps2", hopper, at_zero, kRange},
    ChannelTraits{"imu_foot_accel_z_mps2", hopper, at_zero, kRange},
    ChannelTraits{"tof_height_m", hopper, never, kRange},
    ChannelTraits{"load_cell_force_N", hopper, at_zero, kRange}, ChannelTraits{"mocap_body_z_m", hopper},
    ChannelTraits{"mocap_foot_z_m", hopper, at_zero}, ChannelTraits{"phase", hopper, always},
    ChannelTraits{"imu_body_gyro_x_radps", hopper, at_zero, kRange},
    ChannelTraits{"imu_body_gyro_y_radps", hopper, at_zero, kRange},
    ChannelTraits{"imu_body_gyro_z_radps", hopper, at_zero, kRange},
    ChannelTraits{"imu_foot_gyro_x_radps", hopper, at_zero, kRange},
    ChannelTraits{"imu_foot_gyro_y_radps", hopper, at_zero, kRange},
    ChannelTraits{"imu_foot_gyro_z_radps", hopper, at_zero, kRange},
    ChannelTraits{"bus_voltage_V", hopper, always}, ChannelTraits{"estimate_body_z_m", hopper, always},
    ChannelTraits{"estimate_foot_z_m", hopper, always},
    ChannelTraits{"estimate_body_velocity_mps", hopper, always},
    ChannelTraits{"estimate_foot_velocity_mps", hopper, always},
    ChannelTraits{"estimate_contact_force_N", hopper, always},
    ChannelTraits{"quasi_static_force_N", hopper, always}, ChannelTraits{"foot_z_m", intruder},
    ChannelTraits{"foot_velocity_mps", intruder, always},  // Prescribed: may be constant on purpose.
    ChannelTraits{"foot_accel_mps2", intruder, at_zero, kRange},
    ChannelTraits{"force_N", intruder, at_zero, kRange}, ChannelTraits{"height_m", falling_body},
    ChannelTraits{"accel_mps2", falling_body, at_zero, kRange},
    ChannelTraits{"pressure_Pa", falling_body, never, kRange},
    // Further accelerometers: along the same axis with other ranges, and two lateral ones.
    ChannelTraits{"accel_2_mps2", falling_body, at_zero, kRange},
    ChannelTraits{"accel_3_mps2", falling_body, at_zero, kRange},
    ChannelTraits{"accel_4_mps2", falling_body, at_zero, kRange},
    ChannelTraits{"lateral_x_accel_mps2", falling_body, at_zero, kRange},
    ChannelTraits{"lateral_y_accel_mps2", falling_body, at_zero, kRange},
    ChannelTraits{"position_rad", rotary_axis}, ChannelTraits{"velocity_radps", rotary_axis, at_zero, kRange},
    ChannelTraits{"torque_Nm", rotary_axis, at_zero, kRange},
    ChannelTraits{"load_cell_torque_Nm", rotary_axis, at_zero, kRange}};

}  // namespace

TrialKind usual_kind(CampaignPlant plant) {
  switch (plant) {
    case hopper:
      return TrialKind::hop;
    case intruder:
      return TrialKind::intrusion;
    case falling_body:
      return TrialKind::drop;
    case rotary_axis:
      return TrialKind::motion;
  }
  return TrialKind::hop;
}

std::span<const ChannelTraits> known_channels() { return kChannels; }

const ChannelTraits* find_channel(CampaignPlant plant, std::string_view name) {
  const auto found = std::find_if(kChannels.begin(), kChannels.end(), [&](const ChannelTraits& channel) {
    return channel.plant == plant && channel.name == name;
  });
  return found == kChannels.end() ? nullptr : &*found;
}

std::optional<CampaignPlant> plant_with_channel(std::string_view name) {
  const auto found = std::find_if(kChannels.begin(), kChannels.end(),
                                  [&](const ChannelTraits& channel) { return channel.name == name; });
  if (found == kChannels.end()) return std::nullopt;
  return found->plant;
}

}  // namespace sandhopper
