#include "firmware/fault_check.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "drivers/can/drive_error.hpp"
#include "drivers/transmit_guard/rule.hpp"
#include "firmware/fault_checks.hpp"

namespace sandhopper {
namespace {

constexpr FaultCheck kPlain{Fault::none, FaultDevice::none,  0, "first value of the event", "",
                            "",          "not written down", ""};

const FaultCheck* find_check(Fault fault) {
  for (const auto& check : kFaultChecks)
    if (check.fault == fault) return &check;
  return nullptr;
}

std::string device_name(FaultDevice device, double number) {
  static constexpr std::array<const char*, 4> kSensors{"body IMU", "foot IMU", "time-of-flight sensor",
                                                       "load cell"};
  const auto i = number >= 0.0 && number < 4.0 ? static_cast<std::size_t>(number) : std::size_t{0};
  switch (device) {
    case FaultDevice::none:
      return "";
    case FaultDevice::motor:
      return i == 0 ? "left motor" : "right motor";
    case FaultDevice::sensor:
      return kSensors[i];
    case FaultDevice::imu_pair:
      return i == 2 ? "both IMUs" : kSensors[i];
  }
  return "";
}

// The limit of sensor_intermittent depends on the sensor. imu_implausible compares the pair of IMUs (device
// 2) or the angular rate of one IMU.
FaultCheck for_device(FaultCheck check, double device) {
  if (check.fault == Fault::sensor_intermittent && device == 2.0) check.limit = "supervision.tof_rate_Hz";
  if (check.fault == Fault::sensor_intermittent && device == 3.0)
    check.limit = "supervision.load_cell_rate_Hz";
  if (check.fault == Fault::imu_implausible && device != 2.0) {
    check.quantity = "angular rate";
    check.unit = "rad/s";
    check.limit = "supervision.imu_gyro_radps";
  }
  return check;
}

std::string with_unit(double value, std::string_view unit) {
  const auto number = std::isfinite(value) ? fmt::format("{:.4g}", value) : std::string("not a number");
  return unit.empty() ? number : fmt::format("{} {}", number, unit);
}

// Name of a value that is a code: of a drive's error, of the transmit guard's rule; empty for any other
// fault.
std::string_view name_of_code(Fault fault, double value) {
  if (!(value >= 0.0 && value < 256.0)) return {};
  const auto code = static_cast<std::uint8_t>(value);
  if (fault == Fault::drive_error) return code < kDriveErrors.size() ? drive_error_name(code) : "";
  const auto& rules = EnumNames<transmit::Rule>::value;
  return fault == Fault::transmit_refused && code < rules.size() ? rules[code] : "";
}

// The further key with its number in front: "30 rad/s (limits.motor_speed_radps)".
std::string with_further_number(const FaultCheck& check, std::string_view words, const ConfigNode* robot) {
  std::string text(words);
  if (robot == nullptr || check.also.empty()) return text;
  const auto at = text.find(check.also);
  const auto number = number_at(*robot, check.also);
  if (at == std::string::npos || !number) return text;
  return text.replace(at, check.also.size(),
                      fmt::format("{} ({})", with_unit(*number, check.also_unit), check.also));
}

std::string limit_text(const FaultCheck& check, const std::string& rule, const std::vector<double>& limits) {
  if (check.limit.empty()) return rule;
  std::string keys(check.limit);
  if (const auto bar = keys.find('|'); bar != std::string::npos) keys.replace(bar, 1, ", ");
  if (limits.empty()) return fmt::format("{} {}", rule, keys);
  if (limits.size() == 2)
    return fmt::format("{} to {} ({})", with_unit(limits[0], ""), with_unit(limits[1], check.unit), keys);
  return fmt::format("{} {} ({})", rule, with_unit(limits[0], check.unit), keys);
}

}  // namespace

bool has_check(Fault fault) { return find_check(fault) != nullptr; }

const FaultCheck& check_of(Fault fault) {
  const auto* check = find_check(fault);
  return check == nullptr ? kPlain : *check;
}

std::optional<double> number_at(const ConfigNode& root, std::string_view key) {
  const ConfigNode* node = &root;
  while (node != nullptr && !key.empty()) {
    const auto dot = key.find('.');
    node = node->find(key.substr(0, dot));
    key = dot == std::string_view::npos ? std::string_view{} : key.substr(dot + 1);
  }
  if (node == nullptr) return std::nullopt;
  if (node->kind == ConfigNode::Kind::real) return node->real;
  if (node->kind == ConfigNode::Kind::integer) return static_cast<double>(node->integer);
  return std::nullopt;
}

FaultReading read_fault(const Event& event, const ConfigNode* robot) {
  const FaultCheck check = for_device(check_of(event.fault), event.values[0]);
  FaultReading reading;
  reading.device = device_name(check.device, event.values[0]);
  reading.quantity = with_further_number(check, check.quantity, robot);
  reading.unit = check.unit;
  reading.value = event.values[check.value_at];
  reading.channels = check.channels;
  reading.limit_key = check.limit;
  for (std::string_view keys = check.limit; robot != nullptr && !keys.empty();) {
    const auto bar = keys.find('|');
    if (const auto number = number_at(*robot, keys.substr(0, bar))) reading.limits.push_back(*number);
    keys = bar == std::string_view::npos ? std::string_view{} : keys.substr(bar + 1);
  }
  if (check.is_plotted) reading.lines = reading.limits;
  if (check.is_plotted && reading.limits.size() == 1 && check.rule == kEitherWay)
    reading.lines.push_back(-reading.limits[0]);
  reading.value_text = with_unit(reading.value, reading.unit);
  if (const auto name = name_of_code(event.fault, reading.value); !name.empty())
    reading.value_text += fmt::format(" ({})", name);
  reading.limit_text = limit_text(check, with_further_number(check, check.rule, robot), reading.limits);
  if (check.is_allowed_second)
    reading.limit_text =
        fmt::format("{} {}, {}", kEitherWay, with_unit(event.values[1], check.unit), reading.limit_text);
  return reading;
}

std::string in_words(const FaultReading& reading) {
  return fmt::format("{}{}{}: {}; allowed: {}", reading.device, reading.device.empty() ? "" : ": ",
                     reading.quantity, reading.value_text, reading.limit_text);
}

}  // namespace sandhopper
