#pragma once
#include "tools/diagnose/effects/common.hpp"

// What laws of dry friction on an axis share.
namespace sandhopper::diagnose {

inline constexpr const char* kAxisSwitchSpeed = "axis.friction_switch_speed_radps";

// Below it believed friction fades through zero.
inline double switch_speed_radps(const Context& context) {
  return context.belief.value(kAxisSwitchSpeed, 0.02);
}

// Friction that nobody believed in need not turn round within the speed that is believed of other friction.
inline EffectParameter own_switch_speed(const Context& context) {
  const double believed = switch_speed_radps(context);
  return {.name = "friction_switch_speed_radps",
          .typical = believed,
          .low = 0.4 * believed,
          .high = 4.0 * believed};
}

}  // namespace sandhopper::diagnose
