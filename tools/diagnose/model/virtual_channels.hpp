#pragma once

// Channel names that only sensor edits use; no recording has them.
namespace sandhopper::diagnose {

// Rotary axis: error of the velocity reading that depends on the angle. The law takes an AxisState with both.
inline constexpr const char* kVelocityOfAngle = "velocity_radps of position_rad";

}  // namespace sandhopper::diagnose
