#pragma once
#include <array>
#include <cstdint>

#include "config/fields.hpp"

namespace sandhopper {

// Request to the drives: off (leave motor mode), enable (enter motor mode with zero gains), or run.
enum class DriveRequest : std::uint8_t { off, enable, run };
template <>
struct EnumNames<DriveRequest> {
  static constexpr std::array<std::string_view, 3> value{"off", "enable", "run"};
};

// Largest age of a motor sample from which the host may compute position or velocity gains, for a drive
// without such a law (servo dialect). Such a drive sends its status every 2 to 2.5 ms, so two lost frames in
// a row are tolerated and three are not.
inline constexpr double kHostLawAge_s = 0.006;

// Law inside the drive: torque = kp (position_rad - measured) + kd (velocity_radps - measured) + torque_Nm.
// Values are on the link side, with the signs of MotorSample.
struct MotorCommand {
  double position_rad = 0.0;
  double velocity_radps = 0.0;
  double kp_Nm_per_rad = 0.0;
  double kd_Nm_s_per_rad = 0.0;
  double torque_Nm = 0.0;

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("position_rad", self.position_rad);
    visit("velocity_radps", self.velocity_radps);
    visit("kp_Nm_per_rad", self.kp_Nm_per_rad);
    visit("kd_Nm_s_per_rad", self.kd_Nm_s_per_rad);
    visit("torque_Nm", self.torque_Nm);
  }
};

}  // namespace sandhopper
