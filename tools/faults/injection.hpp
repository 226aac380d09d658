#pragma once
#include <array>
#include <cstdint>

#include "config/fields.hpp"

// Devices, and the kinds of faults that can be planted in them.
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

// Sensors and motors: off (no data), stuck (repeats the last value), garbage (random values), wrong (offset
// or factor), slow (a fraction of the rate), delayed (correct but old), intermittent (gaps), saturated (end
// of the range). All other kinds belong to single devices.
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
  drifting,     // the position drifts away slowly
  error,        // error code 5
  hot,          // 120 deg C
  current,      // reported current 10 A too large
  overcurrent,  // reports 60 A
  undervoltage,
  // Sensors.
  future,    // time stamps 10 ms in the future
  backward,  // time stamps decrease
  not_a_number,
  // The bus.
  cable_off,  // no node acknowledges: error-passive
  blocked,    // frames do not leave, and no error frame reports it
  refused,    // ENOBUFS
  bus_off,
  passive,
  no_acknowledge,
  lost,
  late,
  duplicated,
  foreign,    // a frame of another dialect with a drive's identifier
  malformed,  // replies of a wrong length
  overflow,
  protocol_error,
  miscoded,  // the driver codes full torque into its commands
  // E-stop.
  pressed,
  tapped,  // pressed and released between two cycles
  wire_cut,
  // The computer.
  stalled,   // misses 50 cycles in a row
  overruns,  // misses every second cycle
  watchdog,  // the watchdog had to switch the torque off
  // The robot, or a limit set so close that a sound robot exceeds it.
  tilting,
  lifted,  // both IMUs report an upward acceleration that does not exist
  biased,  // the same, but small: an offset of both IMUs
  limit,
  // Only for pairs of faults.
  announced_loss,  // a drive reports under-voltage, then loses power
  clock_step,      // the computer's date steps by an hour
  disk_full,       // no write succeeds, not even into reserved space
  restart          // a new session of the program; the other defect stays
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
