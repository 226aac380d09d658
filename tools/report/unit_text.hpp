#pragma once
#include <string>
#include <utility>

namespace sandhopper {

// A unit as it is printed: "m/s^2" becomes "m/s²".
inline std::string with_powers(std::string unit) {
  for (const auto& [typed, set] : {std::pair{"^2", "²"}, std::pair{"^3", "³"}})
    for (auto at = unit.find(typed); at != std::string::npos; at = unit.find(typed)) unit.replace(at, 2, set);
  return unit;
}

}  // namespace sandhopper
