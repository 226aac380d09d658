#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "config/node.hpp"
#include "firmware/event.hpp"

namespace sandhopper {

// Kind of device whose number stands first in a fault's event.
enum class FaultDevice : std::uint8_t { none, motor, sensor, imu_pair };

// Meaning of the two values of a fault's event (the calls of Findings::add in firmware/supervision).
struct FaultCheck {
  Fault fault = Fault::none;
  FaultDevice device = FaultDevice::none;
  std::size_t value_at = 0;     // of Event::values: what was seen
  std::string_view quantity{};  // in words
  std::string_view unit{};      // "" for counts and states
  std::string_view limit{};     // key of robot.toml, or two as "low|high"; empty: the rule says all
  std::string_view rule{};      // what a sound robot keeps to: "at most", completed by the limit's number
  std::string_view channels{};  // of the explanation's plots: those that show the quantity
  bool is_plotted = false;      // a plot shows this very quantity, so the limit is drawn in it
  std::string_view also{};      // a further key in quantity or rule, said with its number
  std::string_view also_unit{};
  bool is_allowed_second = false;  // Event::values[1] is what was allowed at that moment, either way
};

bool has_check(Fault fault);
// A fault without an entry of its own gets one that names the first value plainly.
const FaultCheck& check_of(Fault fault);

struct FaultReading {
  std::string device;    // "left motor"; "" where the check is of no one device
  std::string quantity;  // "winding temperature"
  std::string unit;
  double value = 0.0;
  std::vector<double> limits;  // none, one, or low and high
  std::string limit_key;       // "supervision.winding_temperature_C", "low|high"; "" for a fixed rule
  std::string value_text;      // "112.4 °C"
  std::string limit_text;      // "at most 110 °C (supervision.winding_temperature_C)"
  std::string channels;
  std::vector<double> lines;  // limits to draw in the plots of `channels`
};

// `robot` is the configuration that the log carries; null: the limits' numbers are not known.
FaultReading read_fault(const Event& event, const ConfigNode* robot);
// "left motor: speed: 31.2 rad/s; allowed: between plus and minus 30 rad/s (limits.motor_speed_radps)"
std::string in_words(const FaultReading& reading);

// The number under a dotted key, "estimator.kalman.tof_gate_sigma".
std::optional<double> number_at(const ConfigNode& root, std::string_view dotted_key);

}  // namespace sandhopper
