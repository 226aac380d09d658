#pragma once
#include <array>
#include <cstdint>

#include "config/fields.hpp"

// What can be made to go wrong, where and when.
namespace sandhopper::faults {

enum class Device : std::uint8_t {
  motor_left,
  motor_right,
  imu_body,
  imu_foot,
  tof,
  load_cell,
  bus,
  estop,
  computer,
  robot
};

// Of sensors and motors: off: nothing comes any more · stuck: the last value for ever · garbage: random
// values · wrong: off by an offset or a factor · slow: at a fraction of its rate · delayed: right but old ·
// intermittent: with gaps · saturated: the end of the range. The rest is the devices' own.
enum class Kind : std::uint8_t {
  off,
  stuck,
  garbage,
  wrong,
  slow,
  delayed,
  intermittent,
  saturated,
  // Motors.
  drifting,     // position runs away slowly
  error,        // error code 5
  hot,          // 120 deg C
  current,      // 10 A too much reported
  overcurrent,  // 60 A reported
  undervoltage,
  // Sensors.
  future,    // stamped ten milliseconds ahead
  backward,  // stamps run backwards
  not_a_number,
  // The bus.
  cable_off,  // nobody acknowledges: error-passive
  blocked,    // frames do not leave and no error frame says so
  refused,    // ENOBUFS
  bus_off,
  passive,
  no_acknowledge,
  lost,
  late,
  duplicated,
  foreign,    // frames of another dialect with a drive's identifier
  malformed,  // replies of a wrong length
  overflow,
  protocol_error,
  miscoded,  // the driver codes commands with full torque
  // E-stop.
  pressed,
  tapped,  // pressed and released between two cycles
  wire_cut,
  // The computer.
  stalled,   // the cycle misses 50 grid points
  overruns,  // every second grid point is missed
  watchdog,  // the watchdog had to take the torque away
  // The robot, or a limit drawn so close that a sound robot meets it.
  tilting,
  lifted,  // both IMUs feel a push upward that is not there
  biased,  // the same, weak: their zeros moved
  limit,
  // For pairs of faults.
  announced_loss,  // of a drive: it reports under-voltage, then it is gone
  clock_step,      // of the computer's date, by an hour
  disk_full,       // nothing more can be written, not even what was reserved
  restart          // a new session of the program while what is broken stays broken
};

}  // namespace sandhopper::faults

namespace sandhopper {

template <>
struct EnumNames<faults::Device> {
  static constexpr std::array<std::string_view, 10> value{"motor_left", "motor_right", "imu_body", "imu_foot",
                                                          "tof",        "load_cell",   "bus",      "estop",
                                                          "computer",   "robot"};
};
template <>
struct EnumNames<faults::Kind> {
  static constexpr std::array<std::string_view, 45> value{
      "off",        "stuck",          "garbage",        "wrong",        "slow",
      "delayed",    "intermittent",   "saturated",      "drifting",     "error",
      "hot",        "current",        "overcurrent",    "undervoltage", "future",
      "backward",   "not_a_number",   "cable_off",      "blocked",      "refused",
      "bus_off",    "passive",        "no_acknowledge", "lost",         "late",
      "duplicated", "foreign",        "malformed",      "overflow",     "protocol_error",
      "miscoded",   "pressed",        "tapped",         "wire_cut",     "stalled",
      "overruns",   "watchdog",       "tilting",        "lifted",       "biased",
      "limit",      "announced_loss", "clock_step",     "disk_full",    "restart"};
};

}  // namespace sandhopper
