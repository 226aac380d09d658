#pragma once
#include <map>
#include <string>

namespace sandhopper::diagnose {

// "drag_coefficient" or "viscous_friction_Nm_s" for a reader.
struct Quantity {
  std::string words;  // "viscous friction"
  std::string unit;   // "N m s"; empty: none

  std::string label() const { return unit.empty() ? words : words + ", " + unit; }
};
Quantity quantity_of(const std::string& key);

// A trial for a reader: "drop, release height 2 m, payload 0.1 kg"; the session says nothing about what was
// done.
std::string trial_in_words(const std::string& kind, const std::map<std::string, std::string>& words,
                           const std::map<std::string, double>& setup);

// Four digits, no zeros at the end, no exponent between 0.001 and 100,000.
std::string number(double value);

// A value with its interval, both to two digits of the interval's half width: "0.532 (0.525 to 0.540) N".
std::string with_interval(double value, double low, double high, const std::string& unit);

}  // namespace sandhopper::diagnose
