#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "config/node.hpp"
#include "firmware/event.hpp"

namespace sandhopper {

// Kind of device whose number is the first value of a fault's event.
enum class FaultDevice : std::uint8_t { none, motor, sensor, imu_pair };

// Meaning of the two values of a fault's event (the calls of Findings::add in firmware/supervision).
struct FaultCheck {
  Fault fault = Fault::none;
  FaultDevice device = FaultDevice::none;
  std::size_t value_at = 0;     // index into Event::values of the measured value
  std::string_view quantity{};  // name of that value in words
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
// A fault without an entry of its own gets a general one that names the first value.
const FaultCheck& check_of(Fault fault);

struct FaultReading {
  std::string device;    // "left motor"; "" if the check concerns no single device
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

// `robot` is the configuration in the log. If it is null the limits' numbers are unknown.
FaultReading read_fault(const Event& event, const ConfigNode* robot);
// One sentence, e.g. "left motor: speed: 31.2 rad/s; allowed: between plus and minus 30 rad/s (...)".
std::string in_words(const FaultReading& reading);

// The number under a dotted key, "estimator.kalman.tof_gate_sigma".
std::optional<double> number_at(const ConfigNode& root, std::string_view dotted_key);

}  // namespace sandhopper
