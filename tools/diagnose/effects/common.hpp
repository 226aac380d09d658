#pragma once
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tools/diagnose/effect.hpp"

// What effects share.
namespace sandhopper::diagnose {

inline constexpr double kSwitchSpeed_mps = 0.01;  // of friction laws: below it they fade through zero

inline double sign_smooth(double velocity, double switch_speed) { return std::tanh(velocity / switch_speed); }

inline std::vector<std::string> present(const Context& context, std::initializer_list<const char*> channels) {
  std::vector<std::string> found;
  for (const char* channel : channels)
    if (context.has(channel)) found.emplace_back(channel);
  return found;
}

inline double range_of(const Context& context, const std::string& channel) {
  const auto it = context.channels.find(channel);
  return it == context.channels.end() ? 1.0 : std::max(it->second.high - it->second.low, 1e-12);
}

// "m" of "height_m", for the names of parameters.
inline std::string unit_of(const std::string& channel) {
  for (const char* unit : {"mps2", "radps", "mps", "rad", "Nm", "N", "m", "Pa", "A"})
    if (channel.ends_with(std::string("_") + unit)) return unit;
  return "unit";
}

}  // namespace sandhopper::diagnose
