#pragma once
#include <cstdint>
#include <map>
#include <string>

namespace sandhopper::diagnose {

// A key such as "viscous_friction_Nm_s", split into words and unit for the reader of an answer.
struct Quantity {
  std::string words;  // "viscous friction"
  std::string unit;   // "N m s"; empty: none

  std::string label() const { return unit.empty() ? words : words + ", " + unit; }
};
Quantity quantity_of(const std::string& key);

std::string in_words(std::string name);  // "fast_fall" -> "fast fall"

inline constexpr double kShort_m = 0.1;  // lengths below are written in mm
// A value with its unit, to three significant digits: "1.9 m", "46 mm".
std::string measured(double value, const std::string& unit);

// A trial as text. label: "drop, release height 2 m, payload 0.1 kg". order: the head of a sentence that
// tells a lab what to do, "Drop the body from 2 m, payload 0.1 kg". The key `session` is left out, because it
// does not describe what was done.
enum class Telling : std::uint8_t { label, order };
std::string trial_in_words(const std::string& kind, std::map<std::string, std::string> words,
                           std::map<std::string, double> setup, Telling telling = Telling::label);

// Four significant digits; three below 0.001 and from 100,000 on. No trailing zeros, and no exponent between
// 0.001 and 10,000.
std::string number(double value);

// A value with its interval, both to two digits of the interval's half-width: "0.5320 N (95 %: 0.5250 to
// 0.5400)".
std::string with_interval(double value, double low, double high, const std::string& unit);

}  // namespace sandhopper::diagnose
