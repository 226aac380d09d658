#pragma once
#include "tools/diagnose/effects/common.hpp"

// Shared by the laws of dry friction on an axis.
namespace sandhopper::diagnose {

inline constexpr const char* kAxisSwitchSpeed = "axis.friction_switch_speed_radps";

// Speed below which the believed friction goes to zero.
inline double switch_speed_radps(const Context& context) {
  return context.belief.value(kAxisSwitchSpeed, 0.02);
}

// Friction that is not in the belief may have another switch speed than the believed friction.
inline EffectParameter own_switch_speed(const Context& context) {
  const double believed = switch_speed_radps(context);
  return {.name = "friction_switch_speed_radps",
          .typical = believed,
          .low = 0.4 * believed,
          .high = 4.0 * believed};
}

}  // namespace sandhopper::diagnose
