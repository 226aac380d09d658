#pragma once

// What effects change in readings and is no recorded channel of its own.
namespace sandhopper::diagnose {

// Of a rotary axis, the velocity where what it is read as hangs on the angle; a law of both (AxisState).
inline constexpr const char* kVelocityOfAngle = "velocity_radps of position_rad";

}  // namespace sandhopper::diagnose
