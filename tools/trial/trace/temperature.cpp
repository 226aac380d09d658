#include "tools/trial/trace/temperature.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "config/fields.hpp"

namespace sandhopper::trace {

namespace {

// The lowest code of byte 6 in every reply: the drive does not measure it, or the sensor's wire is broken.
bool find_lowest(const TraceReport& report, std::size_t m, const CubeMarsConfig& motor, Findings& out) {
  constexpr double kLowest_C = -40.0;
  if (motor.dialect != Dialect::mit || motor.reply != ReplyFlavour::temperature_offset_40) return false;
  std::uint64_t count = 0;
  for (const auto& reading : report.decoded)
    count += static_cast<std::size_t>(reading.reading.side) == m &&
             reading.reading.sample.temperature_C == kLowest_C;
  if (count == 0 || count < report.motors[m].replies) return false;
  out.push_back(
      {"no_temperature",
       fmt::format("motor {}: all {} replies give -40 degrees C, the lowest code: its drive sends no "
                   "temperature, or its sensor is broken",
                   motor.name, count),
       "if it has no sensor, write reply = \"plain\" for this motor in robot.toml"});
  return true;
}

// No robot stands indoors below the freezing point of water: the offset of the field is another one.
void find_freezing(const TraceReport& report, std::size_t m, const CubeMarsConfig& motor, Findings& out) {
  constexpr double kFreezing_C = 0.0;
  const TimedReading* first = nullptr;
  double coldest_C = kFreezing_C;
  std::uint64_t count = 0;
  for (const auto& reading : report.decoded) {
    const double temperature_C = reading.reading.sample.temperature_C;
    if (static_cast<std::size_t>(reading.reading.side) != m || !(temperature_C < kFreezing_C)) continue;
    if (count++ == 0) first = &reading;
    coldest_C = std::min(coldest_C, temperature_C);
  }
  if (first == nullptr) return;
  const bool offset = motor.dialect == Dialect::mit && motor.reply == ReplyFlavour::temperature_offset_40;
  out.push_back(
      {"motor_below_freezing",
       fmt::format("motor {}: {} of {} replies give a temperature below 0 degrees C, down to {:.0f}, "
                   "first in line {}",
                   motor.name, count, report.motors[m].replies, coldest_C, first->line),
       offset ? fmt::format("if it is not that cold, its drive may send the temperature without the "
                            "offset of 40 ({:.0f} degrees C): compare its manual and write reply = "
                            "\"temperature\" for this motor in robot.toml; a hot motor is else "
                            "noticed 40 degrees too late",
                            coldest_C + 40.0)
              : "if it is not that cold, see the drive's manual and its sensor"});
}

}  // namespace

Findings temperature_findings(const TraceReport& report, const CanConfig& config, double limit_C) {
  Findings out;
  for (std::size_t m = 0; m < static_cast<std::size_t>(config.motor_count); ++m) {
    const auto& motor = config.motor[m];
    if (!find_lowest(report, m, motor, out)) find_freezing(report, m, motor, out);
    const TimedReading* first = nullptr;
    double hottest_C = limit_C;
    std::uint64_t count = 0;
    for (const auto& reading : report.decoded) {
      if (static_cast<std::size_t>(reading.reading.side) != m) continue;
      if (!(reading.reading.sample.temperature_C > limit_C)) continue;  // NaN: not measured
      if (count++ == 0) first = &reading;
      hottest_C = std::max(hottest_C, reading.reading.sample.temperature_C);
    }
    if (first == nullptr) continue;
    std::string cure = "let the motor cool down before the next trial";
    if (motor.dialect == Dialect::mit)
      cure = fmt::format(
          "if it was not hot, compare reply = \"{}\" of this motor in robot.toml with its "
          "manual: some drives send the temperature with another offset, or the bus voltage; "
          "else let it cool down",
          EnumNames<ReplyFlavour>::value[static_cast<std::size_t>(motor.reply)]);
    out.push_back(
        {"motor_hot",
         fmt::format("motor {}: {} of {} replies give more than limits.motor_temperature_C = {:g}, up "
                     "to {:.0f} degrees C, first in line {}",
                     motor.name, count, report.motors[m].replies, limit_C, hottest_C, first->line),
         cure, false});
  }
  return out;
}

}  // namespace sandhopper::trace
